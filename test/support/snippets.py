"""Runs a piece of Python as a notebook does."""

from __future__ import annotations

import ast
from typing import Any


def run(code: str, names: dict[str, Any]) -> Any:
    """Run `code` among `names` and give the value of its last line, as a notebook shows it; None where it has none."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "<snippet>", "exec"), names)
    return eval(compile(ast.Expression(last.value), "<snippet>", "eval"), names) if last else None
