"""Missing physics from data: locate the mismatch, name it, model it, and show that the fit improves."""
