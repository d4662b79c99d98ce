"""The result of a search: the verdict, how sure each effect is, and what cannot be distinguished."""
