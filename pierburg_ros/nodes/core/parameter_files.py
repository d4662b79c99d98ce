"""Which parameter files say something to a node, so that one that says nothing is not passed over. Knows no ROS."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import yaml

OPTION = "--params-file"


def given_files(arguments: Sequence[str]) -> list[Path]:
    """The parameter files named among command-line arguments."""
    return [Path(path) for option, path in pairwise(arguments) if option == OPTION]


def unread_files(node: str, arguments: Sequence[str]) -> list[str]:
    """A complaint about each file among the arguments of which nothing holds for `node` (its full name)."""
    complaints = []
    for path in given_files(arguments):
        keys = keys_of(path)
        if keys and not any(matches(key, node) for key in keys):
            complaints.append(
                f"{path} says nothing to {node} (it names {', '.join(keys)}), expected a key that holds for it."
                " Write /** in place of the name."
            )
    return complaints


def keys_of(path: Path) -> list[str]:
    """The nodes that a parameter file names, namespaces before them; none where it is no such file."""
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return []  # ROS itself says what is wrong with it
    return list(sections(content, ""))


def sections(content: Any, above: str) -> Iterator[str]:
    """The full keys of all sections with parameters, from the content below `above`."""
    for key, value in content.items() if isinstance(content, dict) else ():
        name = f"{above}/{str(key).strip('/')}"
        if isinstance(value, dict) and "ros__parameters" in value:
            yield name
        elif isinstance(value, dict):
            yield from sections(value, name)


def matches(key: str, node: str) -> bool:
    """Whether a key holds for a node: * stands for one name in its path, ** for any number of them."""
    pattern = re.escape(key).replace(r"/\*\*", "(/[^/]+)*").replace(r"\*", "[^/]+")
    return re.fullmatch(pattern, node) is not None
