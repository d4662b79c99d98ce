"""The options that every command has, added where it is registered: a command neither declares nor sees them.

--quiet  prints nothing but errors
--json   prints the command's result document, and nothing else, on the standard output
-o       short for --output; a command without an --output gets one, which writes the document into a file

For its part a command prints with `cli.terminal.terminal`, shows progress with `cli.progress.progress`, and returns its
result document: the text of its JSON file, or what such a text is made from.
"""

from __future__ import annotations

import inspect
import json
import sys
from collections.abc import Callable
from copy import copy
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

import typer

from pierburg_ros.cli.console.terminal import loudness
from pierburg_ros.library.output import refuse_no_file, write_whole

OUTPUT = ("--output", "-o")
QUIET = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
JSON = Annotated[
    bool, typer.Option("--json", help="Print the result document as JSON, and nothing else, on standard output.")
]
DOCUMENT = Annotated[Path | None, typer.Option(*OUTPUT, metavar="FILE", help="Write the result document as JSON.")]


def with_common(function: Callable[..., Any]) -> Callable[..., None]:
    """`function` as a command with the common options, which prints the document that it returns if asked to."""
    signature = inspect.signature(function, eval_str=True)
    own = [shortened(parameter) for parameter in signature.parameters.values()]
    extra: dict[str, Any] = {"quiet": QUIET, "as_json": JSON}
    has_output = "output" in signature.parameters
    if not has_output:
        extra = {"output": DOCUMENT, **extra}

    @wraps(function)
    def command(*arguments: Any, quiet: bool = False, as_json: bool = False, **given: Any) -> None:
        into = None if has_output else given.pop("output", None)
        if into is not None:
            refuse_no_file(into)
        with loudness(results=not (quiet or as_json), progress=not quiet):
            document = function(*arguments, **given)
        if as_json:
            sys.stdout.write(text(document))
        if into is not None:
            write_whole(into, text(document))

    added = [keyword_only(name, annotation) for name, annotation in extra.items()]
    parameters = [*own, *added]
    command.__signature__ = signature.replace(parameters=parameters, return_annotation=None)  # type: ignore[attr-defined]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command


def keyword_only(name: str, annotation: Any) -> inspect.Parameter:
    """An option that is off, or None, unless it is given."""
    default = False if get_args(annotation)[0] is bool else None
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def shortened(parameter: inspect.Parameter) -> inspect.Parameter:
    """The parameter with -o beside --output, and a switch without the --no- that nobody needs."""
    if get_origin(parameter.annotation) is not Annotated:
        return parameter
    kind, option = get_args(parameter.annotation)
    switch = kind is bool and not option.param_decls and option.default is ...
    if parameter.name != "output" and not switch:
        return parameter
    named = copy(option)
    named.default = ...
    named.param_decls = OUTPUT if parameter.name == "output" else (f"--{parameter.name.replace('_', '-')}",)
    return parameter.replace(annotation=Annotated[kind, named])


def text(document: Any) -> str:
    """A result document as JSON text."""
    if isinstance(document, str):
        return document if document.endswith("\n") else f"{document}\n"
    return json.dumps(document, indent=1, allow_nan=False) + "\n"
