"""How strong an effect that is not named may be without contradicting the recordings."""
