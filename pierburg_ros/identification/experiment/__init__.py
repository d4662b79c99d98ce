"""Experiments: excitation recipes, and the sequence that distinguishes two explanations."""
