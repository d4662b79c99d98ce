"""What every result can do: be read as JSON, saved, drawn, put into a table, and shown in a notebook."""

from __future__ import annotations

import base64
import html
import io
from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pierburg_ros.library.output import output_folder

if TYPE_CHECKING:
    import pandas
    import plotly.graph_objects as go
    from matplotlib.figure import Figure


class Result(ABC):
    """The outcome of a job."""

    @abstractmethod
    def to_json(self) -> str:
        """The outcome as JSON text, as the command of this job writes it."""

    @abstractmethod
    def write_into(self, folder: Path) -> None:
        """Write every file of the outcome into an existing folder."""

    @abstractmethod
    def figure(self) -> go.Figure:
        """The outcome as a Plotly figure, to be zoomed."""

    @abstractmethod
    def picture(self) -> Figure:
        """The outcome as a Matplotlib figure, to be printed."""

    @abstractmethod
    def table(self) -> pandas.DataFrame:
        """The numbers of the outcome as a data frame; ImportError where pandas is not installed."""

    @abstractmethod
    def rows(self) -> Mapping[str, str]:
        """The main numbers in words, by what they are."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What the outcome is of, in one line."""

    def save(self, folder: str | Path) -> None:
        """Write the files that the command of this job writes into `folder`: all of them, or nothing.

        The folder is made where it is missing; other files in it stay. InputError where it is a file.
        """
        from pierburg_ros.intake import path_of

        with output_folder(path_of(folder, "the folder for the results")) as temporary:
            self.write_into(temporary)

    def plot(self) -> go.Figure:
        """The same as `figure`, as a recording has it."""
        return self.figure()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.title})"

    def _repr_html_(self) -> str:
        """The main numbers and the picture, for a notebook."""
        cells = (
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in self.rows().items()
        )
        buffer = io.BytesIO()
        self.picture().savefig(buffer, format="png", dpi=80)
        picture = base64.b64encode(buffer.getvalue()).decode("ascii")
        return (
            f"<h4>{html.escape(self.title)}</h4><table>{''.join(cells)}</table>"
            f"<img alt='{html.escape(self.title, quote=True)}' src='data:image/png;base64,{picture}'>"
        )
