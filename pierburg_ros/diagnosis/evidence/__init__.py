"""What the recordings hold: runs, their noise, what the shaft does in them, the torque that a model misses."""
