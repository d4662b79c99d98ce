"""The frame of every page that a command writes: one file that needs no network, its style, its plots, its numbers."""
