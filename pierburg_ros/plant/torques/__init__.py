"""What drives, loads and brakes the shaft, and what its sensor shows."""
