"""A diagnosis for people and programs: the terms of diagnosis.json, words, page, figures, terminal."""
