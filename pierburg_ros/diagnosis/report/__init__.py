"""Presentation of a diagnosis for people and programs: diagnosis.json, words, page, figures, terminal."""
