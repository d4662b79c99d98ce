"""Samples that tell nothing of the actuator, taken out of recordings before anything is fitted, and said."""
