"""Numbers that a module names in capitals: their values as written, and what their docstrings say.

A docstring says what its number decides, and then, after one of the words of `GROUNDS`, the reason for its value.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "pierburg_ros"
GROUNDS = ("Derived", "Measured", "Work", "Given", "Chosen")


@dataclass(frozen=True)
class NamedNumber:
    """A named number: its value as written, its file in the package, and its docstring in three parts."""

    name: str
    value: str
    file: str
    decides: str
    ground: str
    reason: str


def numbers_of(folder: str = "") -> Iterator[NamedNumber]:
    """The named numbers of a folder of the package, or of all of it, by file."""
    for source in sorted((PACKAGE / folder).rglob("*.py")):
        for name, value, docstring in named_numbers(source.read_text(encoding="utf-8")):
            yield NamedNumber(name, value, str(source.relative_to(PACKAGE)), *parts(docstring))


def named_numbers(source: str) -> Iterator[tuple[str, str, str]]:
    """Name, value as written and docstring of each number that a module names in capitals."""
    body = ast.parse(source).body
    for node, following in zip_longest(body, body[1:]):
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None or not _is_numeric(node.value):
            continue
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        names = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
        said = following.value if isinstance(following, ast.Expr) else None
        text = str(said.value) if isinstance(said, ast.Constant) else ""
        yield from ((name, ast.unparse(node.value), " ".join(text.split())) for name in names if name.upper() == name)


def parts(docstring: str) -> tuple[str, str, str]:
    """What a threshold decides, the ground for its value, and the reason; empty where the docstring has no ground."""
    found = re.fullmatch(rf"(.+?[.;:]) ({'|'.join(GROUNDS)}): (.+\.)", docstring)
    return (found[1], found[2], found[3]) if found else (docstring, "", "")


def _is_numeric(value: ast.expr) -> bool:
    """Whether an expression holds a number and no text but names of a table's rows."""
    keys = {id(key) for node in ast.walk(value) if isinstance(node, ast.Dict) for key in node.keys}
    constants = [n for n in ast.walk(value) if isinstance(n, ast.Constant) and id(n) not in keys]
    numbers = [constant for constant in constants if type(constant.value) in (int, float)]
    return bool(numbers) and len(numbers) == len(constants)
