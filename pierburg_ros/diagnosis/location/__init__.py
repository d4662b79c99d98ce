"""Where a mismatch is: in windows of time, and in ranges of the shaft's motion."""
