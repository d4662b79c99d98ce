"""XML as people read it: elements with numbers as attributes, under a comment that says what is not in the file."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

__all__ = ["Element", "SubElement", "child", "document", "numbers"]


def numbers(*values: float) -> str:
    """Numbers for an attribute, as short as they can be told back."""
    return " ".join(f"{value + 0.0:.12g}" for value in values)


def child(parent: Element, tag: str, **attributes: str | float) -> Element:
    """A new element under `parent`."""
    texts = {name: each if isinstance(each, str) else numbers(each) for name, each in attributes.items()}
    return SubElement(parent, tag, texts)


def document(root: Element, remarks: Sequence[str]) -> str:
    """The file, with `remarks` as its first comment."""
    ElementTree.indent(root)
    comment = "\n     ".join(line.replace("--", "- -") for line in remarks)
    return f'<?xml version="1.0"?>\n<!-- {comment} -->\n{ElementTree.tostring(root, encoding="unicode")}\n'
