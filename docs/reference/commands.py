"""The commands with their options, from the command line itself."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import typer

from pierburg_ros.cli.app import COMMANDS, application
from reference.markdown import code, table


def page() -> str:
    """A section for each command and each of its own commands."""
    return "\n".join(_section(f"pierburg {name}", command_of(name)) for name in COMMANDS)


def command_of(name: str) -> Any:
    """A command as the command line has it; a group has `commands` of its own."""
    return typer.main.get_command(application(name)).commands[name]  # type: ignore[attr-defined]


def _section(name: str, command: Any) -> str:
    """A command and, for a group, its members."""
    members = getattr(command, "commands", {})
    own = [f"## {name}\n\n{inspect.cleandoc(command.help or '')}\n"]
    if not members:
        own.append(table(("argument or option", "", "meaning"), map(_row, command.params)))
    return "\n".join([*own, *(_section(f"{name} {each}", member) for each, member in members.items())])


def _row(parameter: Any) -> tuple[str, str, str]:
    is_option = parameter.param_type_name == "option"
    options = [*parameter.opts, *parameter.secondary_opts]
    names = options if is_option else [(parameter.metavar or parameter.name).upper()]
    needed = "needed" if parameter.required else _default(parameter)
    return ", ".join(code(name) for name in names), needed, (parameter.help or "").replace("\n", " ")


def _default(parameter: Any) -> str:
    shown = getattr(parameter, "show_default", None)
    value = shown if isinstance(shown, str) else parameter.default
    if isinstance(value, bool) or value == "" or not isinstance(value, (int, float, str, Path)):
        return ""
    return f"default {value}"
