"""Missing physics from data: locate the mismatch, name it, model it, show the fit improve."""
