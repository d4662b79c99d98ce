"""The fields of diagnosis.json, from its schema."""

from __future__ import annotations

import re
from typing import Any, get_args

from pierburg_ros.diagnosis import schema
from reference.markdown import code, table


def page() -> str:
    """The document first, then its parts, each in the order of the schema."""
    parts = [part for part in vars(schema).values() if isinstance(part, type) and issubclass(part, schema.Part)]
    shown = [schema.Diagnosis, *(part for part in parts if part not in (schema.Part, schema.Diagnosis))]
    return "\n".join(f"## {part.__name__}\n\n{part.__doc__}\n\n{_fields(part)}" for part in shown)


def _fields(part: Any) -> str:
    rows = (
        (code(field.alias or name), _kind(field.annotation), field.description or "")
        for name, field in part.model_fields.items()
    )
    return table(("field", "is", "meaning"), rows)


def _kind(annotation: Any) -> str:
    """A type as JSON has it."""
    if annotation in _NAMES:
        return _NAMES[annotation]
    if isinstance(annotation, type) and issubclass(annotation, schema.Part):
        return f"[{annotation.__name__}](#{annotation.__name__.lower()})"
    text, inner = re.sub(r"typing\.|\[.*", "", str(annotation)), get_args(annotation)
    if text == "Literal":
        return " or ".join(code(choice) for choice in inner)
    if text == "list":
        return f"list of {_kind(inner[0])}"
    if text == "dict":
        return f"by name: {_kind(inner[1])}"
    if text == "tuple":
        return "two numbers"
    return " or ".join(_kind(each) for each in inner if each is not type(None)) + " or null"


_NAMES: dict[Any, str] = {str: "text", float: "number", int: "whole number", bool: "true or false"}
