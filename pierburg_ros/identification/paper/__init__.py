"""The paper's own procedure: static characteristic, step response, its table checked against itself."""
