"""Parameters of a model from recordings: the one engine of identification and diagnosis."""
