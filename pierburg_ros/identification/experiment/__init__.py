"""Experiments: excitation recipes, and the sequence that tells two explanations apart."""
