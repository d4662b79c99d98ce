"""Pages: a template within the frame that all share, with the plots, the signals and plotly.js inside one file."""

from __future__ import annotations

import base64
import json
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

import jinja2
import numpy as np
import plotly.graph_objects as go
from plotly.offline import get_plotlyjs

from pierburg_ros.arrays import Signal
from pierburg_ros.pages import numbers

FRAME = "pierburg_ros.pages"
STEPS = 32767
"""Steps of a stored signal to either side of zero: 16 bits, of the largest value 0.003 %."""


@dataclass(frozen=True)
class Plot:
    """A plot on a page: a name unlike any other there, what it shows in words, and its height [px]."""

    id: str
    figure: go.Figure
    caption: str
    height: int

    @property
    def json(self) -> str:
        """Curves and layout for the page's own script; curves over time refer to the signals of the page."""
        figure = json.loads(self.figure.to_json(validate=False, remove_uids=True))
        for trace in figure["data"]:
            if "time" in trace.get("meta", {}):
                trace["x"] = trace["y"] = []
        layout = {
            key: value
            for key, value in figure["layout"].items()
            if key not in ("template", "height", "legend", "title")
        }
        return inert({"data": figure["data"], "layout": layout})


@dataclass(frozen=True)
class Sources:
    """How a command line names the recordings of a page, each with the options it was read with, and its model file."""

    recordings: Sequence[Sequence[str]] = ()
    model: str = "model.yaml"

    def commands(self, *wanted: tuple[str, str, str]) -> list[dict[str, str]]:
        """Commands to copy: of each its purpose, name and output folder; none where no recording is a file."""
        return [
            {
                "purpose": purpose,
                "line": shlex.join(["pierburg", name, *self.recordings[0], "--model", self.model, "--output", output]),
            }
            for purpose, name, output in wanted
            if self.recordings
        ]


NOT_FILES = Sources()
"""Recordings that were not read from files."""


def written(
    package: str, template: str, signals: Mapping[str, Signal], context: Mapping[str, Any], **frame: Any
) -> str:
    """The page of a `template` in `package`, filled with `context`; its plots take their curves from `signals`.

    `frame` is what the frame shows below: `model_file`, `model_said`, `commands`, `provenance`; and `library_at`, where
    the plotting library lies if many pages share it, or `library_later`, whether the page's own script starts the one
    inside. Text is never markup.
    """
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(lambda name: _source(package, name) or _source(FRAME, name)),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(numbers.FILTERS)
    below: dict[str, Any] = {
        "model_file": "",
        "model_said": "The content of model.yaml.",
        "commands": (),
        "provenance": (),
        "library_at": "",
        "library_later": False,
        **frame,
    }
    return environment.get_template(template).render(
        **below,
        **context,
        style=_source(FRAME, "style.css"),
        behaviour=_source(FRAME, "behaviour.js"),
        library="" if below["library_at"] else get_plotlyjs(),
        signals=inert({key: stored(values, key.endswith("time")) for key, values in signals.items()}),
    )


def stored(values: Signal, exact: bool) -> dict[str, Any]:
    """A signal as the page's script reads it: in 32 bits where `exact`, otherwise in 16 bits of its largest value."""
    if exact:
        return {"kind": "f4", "scale": 1.0, "data": _base64(values.astype("<f4"))}
    known = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    scale = float(np.max(np.abs(known), initial=0.0)) / STEPS or 1.0
    return {"kind": "i2", "scale": scale, "data": _base64(np.round(known / scale).astype("<i2"))}


def inert(content: Any) -> str:
    """JSON that a browser cannot take for markup."""
    text = json.dumps(content, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _base64(values: np.ndarray) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")


def _source(package: str, name: str) -> str | None:
    file = resources.files(package) / name
    return file.read_text(encoding="utf-8") if file.is_file() else None
