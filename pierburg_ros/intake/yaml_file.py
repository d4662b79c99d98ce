"""YAML as data and nothing else: numbers, texts, truth values, lists and mappings, bounded in depth and in count.

Dates, tags, octal and sexagesimal numbers are no part of it; a name given twice in one mapping is refused. Aliases are
counted for what they stand for, so that a few lines cannot stand for a billion.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from pierburg_ros.errors import InputError
from pierburg_ros.intake.gate import text_of

DEEPEST_NESTING = 20
"""Nested levels: rosbag2's metadata, the deepest that is read, has seven."""
MOST_NODES = 50_000
"""Values and names together: a residual torque of 24 x 24 has 700, the metadata of 4,000 files 44,000; 50,000 take two
to three seconds to read."""
LONGEST_SCALAR = 65_536
"""Characters of one value: rosbag2 wrote the whole of a topic's offered QoS as one."""
INTEGER = re.compile(r"[-+]?\d{1,18}")
"""Whole numbers that 64 bits hold; longer ones are read as real numbers."""
REAL = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
WORDS = {"": None, "~": None, "null": None, "true": True, "True": True, "false": False, "False": False}


@dataclass(frozen=True)
class Document:
    """The content of a YAML file, and where in it each value stands."""

    content: Any
    tree: yaml.Node | None

    def line(self, *keys: str) -> str:
        """Where the value under nested `keys` stands, as ` line 7`."""
        node = self.tree
        for key in keys:
            if not isinstance(node, yaml.MappingNode):
                break
            node = next((value for name, value in node.value if name.value == key), node)
        return f" line {node.start_mark.line + 1}" if node is not None else ""


def read_yaml(path: str | Path, expected: str) -> Document:
    """The YAML file at `path`."""
    return parsed(text_of(path, expected), str(path), expected)


def parsed(text: str, name: str, expected: str) -> Document:
    """The YAML in `text`; `name` is what messages call it."""
    try:
        tree = BoundedLoader(text).get_single_node()
        return Document(None if tree is None else value_of(tree), tree)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        place = f" line {mark.line + 1}" if mark else ""
        problem = getattr(error, "problem", None) or "characters that YAML does not allow"
        raise InputError(f"{name}{place} is not YAML ({problem}); expected {expected}.") from error


class BoundedLoader(yaml.SafeLoader):
    """Composes the tree of a YAML document and counts it while it grows."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.depth = 0
        self.counted: dict[int, int] = {}
        self.count = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node:
        """One node, once it is known to be within the bounds."""
        event = self.peek_event()  # type: ignore[no-untyped-call]
        if getattr(event, "tag", None) not in (None, "!"):
            raise refused(event, f"the tag {event.tag}", "plain values")
        alias = isinstance(event, yaml.AliasEvent)
        before, self.depth = self.count, self.depth + 1
        if self.depth > DEEPEST_NESTING:
            raise refused(event, "deeply nested lists", f"at most {DEEPEST_NESTING} levels")
        node = super().compose_node(parent, index)
        assert node is not None  # an event that opens a node was seen
        if alias and id(node) not in self.counted:
            raise refused(event, "a value that contains itself", "values that end")
        self.count += self.counted[id(node)] if alias else 1
        self.depth -= 1
        if self.count > MOST_NODES:
            raise refused(event, "too many values", f"at most {MOST_NODES:,}")
        if not alias:
            self.counted[id(node)] = self.count - before
        return node


def refused(event: Any, found: str, expected: str) -> yaml.YAMLError:
    """What to raise where the text is YAML but not what is read here."""
    return yaml.composer.ComposerError(None, None, f"{found}, expected {expected}", event.start_mark)


def value_of(node: yaml.Node) -> Any:
    """What a node stands for."""
    if isinstance(node, yaml.SequenceNode):
        return [value_of(item) for item in node.value]
    if isinstance(node, yaml.MappingNode):
        return mapping_of(node)
    return scalar_of(node)


def mapping_of(node: yaml.MappingNode) -> dict[str, Any]:
    """A mapping; its names are texts, each given once."""
    content: dict[str, Any] = {}
    for name, value in node.value:
        if not isinstance(name, yaml.ScalarNode):
            raise refused(name, "a list or mapping as a name", "a word")
        if name.value in content:
            raise refused(name, f"{name.value[:60]} given twice", "each name once")
        content[name.value] = value_of(value)
    return content


def scalar_of(node: yaml.Node) -> Any:
    """A text where it is quoted; otherwise a number or a truth value where it reads as one."""
    text: str = node.value
    if len(text) > LONGEST_SCALAR:
        raise refused(node, f"a value of {len(text)} characters", f"at most {LONGEST_SCALAR}")
    if node.style is not None:  # type: ignore[attr-defined]
        return text
    if INTEGER.fullmatch(text):
        return int(text)
    if REAL.fullmatch(text):
        return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
    return WORDS.get(text, text)
