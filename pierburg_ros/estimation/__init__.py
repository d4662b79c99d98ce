"""Estimation of model parameters from recordings: the one engine of identification and diagnosis."""
