"""The search: which explanations are possible, and how well each of them fits."""
