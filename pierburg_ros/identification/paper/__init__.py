"""The paper's own way: static characteristic, step response, its table held against itself."""
