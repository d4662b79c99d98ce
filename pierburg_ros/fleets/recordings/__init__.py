"""The recordings of a fleet: where they lie, and which unit each of them is of and when."""
