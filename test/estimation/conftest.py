"""Recordings whose parameters are known."""

from support.known_recordings import closed_form_recording, nominal, rich_recording

__all__ = ["closed_form_recording", "nominal", "rich_recording"]
