"""Follows a running actuator: predicts each movement from the duty, and says when the mismatch is real."""
