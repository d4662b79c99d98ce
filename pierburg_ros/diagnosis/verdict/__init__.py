"""What the search amounts to: the verdict, ties, physics that recordings share, the shape of the unknown."""
