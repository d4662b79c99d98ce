"""A recording beside what a model makes of the same inputs."""
