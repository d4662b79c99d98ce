"""Checks of an actuator's description: derived numbers, slips in it, and which numbers recordings could determine."""
