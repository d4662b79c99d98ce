"""What a description of an actuator implies: derived numbers, slips in it, and what recordings could tell of it."""
