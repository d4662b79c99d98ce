"""A recording beside what a model would have measured."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.comparison import compare as comparison
from pierburg_ros.library import overlays
from pierburg_ros.library.model import Model, ModelLike, chosen_model
from pierburg_ros.library.reading import Readable, read, taken_up
from pierburg_ros.library.result import Result
from pierburg_ros.library.tables import data_frame
from pierburg_ros.recording import Recording
from pierburg_ros.viewers.mcap_overlay import write_mcap
from pierburg_ros.viewers.rerun_overlay import write_rerun

if TYPE_CHECKING:
    import pandas
    import plotly.graph_objects as go
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False, eq=False)
class Comparison(Result):
    """A recording beside the answer of a model to its inputs; `found` has all the numbers."""

    found: comparison.Comparison

    @property
    def recording(self) -> Recording:
        """The recording, from where the shaft is first seen at rest."""
        return self.found.recording

    @property
    def model(self) -> Model:
        """The model that was simulated."""
        return Model.of(self.found.model)

    @property
    def simulated(self) -> NDArray[np.float64]:
        """What the model would have measured, in the recording's unit, shape (samples,)."""
        return self.found.simulated

    @property
    def residual(self) -> NDArray[np.float64]:
        """Measured minus simulated, in the recording's unit, shape (samples,)."""
        return self.found.residual

    @property
    def rmse(self) -> float:
        """Root of the mean squared residual, in the recording's unit."""
        return self.found.rmse

    @property
    def noise(self) -> float:
        """Standard deviation of the measurement's white part, in its unit: what no model can explain."""
        return self.found.noise

    @property
    def title(self) -> str:
        """Recording and actuator."""
        return f"{self.recording.name} and {self.model.actuator.name}"

    def to_json(self) -> str:
        """The content of replay.json."""
        return json.dumps(self.found.as_mapping(), indent=1, allow_nan=False) + "\n"

    def figure(self) -> go.Figure:
        """Measured and simulated, residual, and input over time, as a Plotly figure."""
        from pierburg_ros.comparison.plot import figure

        return figure(self.found)

    def picture(self) -> Figure:
        """The same as a Matplotlib figure."""
        from pierburg_ros.comparison.plot import picture

        return picture(self.found)

    def table(self) -> pandas.DataFrame:
        """One row a sample, columns as in replay.csv: time [s], the input, measured, simulated, residual."""
        return data_frame(self.columns())

    def columns(self) -> dict[str, NDArray[np.float64]]:
        """The columns of replay.csv, each of shape (samples,); the input is the one in force."""
        recording = self.recording
        return {
            "time": recording.time,
            recording.input: recording.command.at(recording.time, before=0.0),
            "measured": recording.measured,
            "simulated": self.simulated,
            "residual": self.residual,
        }

    def rows(self) -> dict[str, str]:
        """What was measured, what acts in the model, and how far both are apart."""
        recording, worst, unit = self.recording, self.found.worst, self.found.unit
        explained = self.found.variance_explained
        return {
            "measured": f"{recording.quantity.replace('_', ' ')} in {unit}, {recording.time.size} samples"
            f" over {recording.duration:.1f} s (times: {recording.time_source}){taken_up(recording)}",
            "effects in the model": ", ".join(self.found.model.active_effects) or "none",
            "RMSE": f"{self.rmse:.4g} {unit}",
            "noise of the measurement": f"{self.noise:.2g} {unit}",
            "variance explained": "nothing moved" if explained is None else f"{100 * explained:.3f} %",
            "worst stretch": f"{worst.start:.2f} to {worst.end:.2f} s: RMSE {worst.rmse:.4g} {unit},"
            f" {100 * worst.share:.0f} % of the residual's energy",
        }

    def write_into(self, folder: Path) -> None:
        """Write replay.json, .csv, .mcap, .html and .png, and the model as model.yaml."""
        from pierburg_ros.comparison.page import replay_page
        from pierburg_ros.library.origin import origin

        (folder / "replay.json").write_text(self.to_json(), encoding="utf-8")
        columns = self.columns()
        table, header = np.column_stack(list(columns.values())), ",".join(columns)
        np.savetxt(folder / "replay.csv", table, fmt="%.9g", delimiter=",", header=header, comments="")
        write_mcap(folder / "replay.mcap", overlays.of_comparison(self.found))
        model = folder / "model.yaml"
        self.model.write(model)
        page = replay_page(self.found, self.rows(), *origin(self.model.actuator, [self.recording], model))
        (folder / "replay.html").write_text(page, encoding="utf-8")
        self.picture().savefig(folder / "replay.png", dpi=120)

    def write_rerun(self, path: str | Path) -> None:
        """Write the signals to a file for the Rerun viewer; InputError where rerun-sdk is not installed."""
        write_rerun(Path(path), [overlays.of_comparison(self.found)])


def compare(recording: Readable, model: ModelLike) -> Comparison:
    """`recording` beside what `model` would have measured under the same input.

    A recording or its path, a model or the path of its file. The simulation begins where the first samples show
    the shaft, at their speed. InputError where it cannot be read or the model cannot be simulated.

        comparison = pr.compare("bench.mcap", pr.Model.nominal("pierburg"))
        print(comparison.rmse, comparison.noise)
    """
    chosen = chosen_model(model)
    measured = recording if isinstance(recording, Recording) else read(recording, actuator=chosen.actuator)
    return Comparison(comparison.compare(chosen, measured))
