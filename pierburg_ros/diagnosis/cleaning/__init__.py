"""Samples that say nothing about the actuator: they are removed before any fit, and reported."""
