"""The remainder that no explanation accounts for: physics that several recordings share, and the shape of the rest."""
