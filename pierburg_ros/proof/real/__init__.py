"""Known effects put into real recordings, for the diagnosis to find beside all that is really there."""
