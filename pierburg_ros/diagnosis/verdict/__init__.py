"""What a search amounts to: the verdict, how sure each effect is, and what cannot be told apart."""
