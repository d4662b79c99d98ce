"""What a file says about itself in its first comment: what it is, how it is driven, and what it does not hold."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.export.contents import Contents


def remarks(contents: Contents, driven: Sequence[str]) -> list[str]:
    """Lines for the comment at the top of a file, `driven` among them."""
    actuator = contents.model.actuator
    acting = ", ".join(contents.model.active_effects) or "none"
    lines = [f"{actuator.title or actuator.name}; written by pierburg export. Effects that act: {acting}.", *driven]
    lines += contents.notes
    left_out = contents.left_out()
    if not left_out:
        return [*lines, "Nothing of the model is left out."]
    return [*lines, "Left out, since this format has no place for it:", *(f"  {each.text}" for each in left_out)]
