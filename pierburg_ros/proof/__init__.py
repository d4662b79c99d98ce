"""Blind trials of the diagnosis, on recordings made by a second formulation of the physics."""
