"""What the recordings contain: runs, their noise, the motion of the shaft, the torque that a model lacks."""
