"""Message types of whatever is installed: their classes, and their definitions as MCAP schemas."""

from __future__ import annotations

import json
import re
from importlib import import_module
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError

_SEPARATOR = "=" * 80
_FIELD = re.compile(r"^\s*(?:(\w+)/)?([A-Z]\w*)(?:\[[^\]]*\])?\s+\w")


def message_class(kind: str) -> Any:
    """The class of a message type such as `std_msgs/msg/Float64`; InputError where it is not installed."""
    package, _, name = kind.split("/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError) as error:
        raise InputError(f"Message type {kind} is not installed; install the package {package}.") from error


def type_name(message: Any) -> str:
    """The name of a message class, such as `std_msgs/msg/Float64`."""
    return f"{message.__module__.split('.')[0]}/msg/{message.__name__}"


def definition(kind: str) -> str:
    """The definition of a type followed by those of all types in it, in the form of a `ros2msg` schema."""
    texts = {kind: _installed(kind, ".msg")}
    waiting = [kind]
    while waiting:
        current = waiting.pop(0)
        for inner in _inner(current, texts[current]):
            if inner not in texts:
                texts[inner] = _installed(inner, ".msg")
                waiting.append(inner)
    own, *others = texts.items()
    parts = [own[1], *(f"MSG: {name.replace('/msg/', '/')}\n{text}" for name, text in others)]
    return f"\n{_SEPARATOR}\n".join(parts)


def type_hash(kind: str) -> str:
    """The hash by which ROS tells versions of a type apart (RIHS01)."""
    described = json.loads(_installed(kind, ".json"))
    hashes = {each["type_name"]: each["hash_string"] for each in described["type_hashes"]}
    return str(hashes[kind])


def _installed(kind: str, suffix: str) -> str:
    """A file of a message type, under the prefix of its Python package as in any ROS install."""
    package, _, name = kind.split("/")
    own = Path("share", package, "msg", f"{name}{suffix}")
    try:
        module = Path(import_module(package).__file__ or "")
        return next(p / own for p in module.parents if (p / own).exists()).read_text(encoding="utf-8")
    except (ImportError, StopIteration) as error:
        raise InputError(f"{kind} has no definition here; install the package {package}.") from error


def _inner(kind: str, text: str) -> list[str]:
    """Types of the fields that are messages themselves."""
    package = kind.split("/")[0]
    found = (_FIELD.match(line.split("#")[0]) for line in text.splitlines())
    return [f"{match[1] or package}/msg/{match[2]}" for match in found if match]
