"""Parameters of an actuator from recordings."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.identification.identify import Identification as Found
from pierburg_ros.identification.identify import identify as identified
from pierburg_ros.inference.replay import parts_of
from pierburg_ros.library.model import ActuatorLike, Model, ModelLike, chosen_model
from pierburg_ros.library.reading import Readable, names, recordings_of
from pierburg_ros.library.result import Result
from pierburg_ros.library.tables import data_frame
from pierburg_ros.recording import Recording

if TYPE_CHECKING:
    import pandas
    import plotly.graph_objects as go
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False, eq=False)
class Identification(Result):
    """The parameters that recordings show, with intervals; `found` has all the numbers."""

    found: Found
    recordings: tuple[Recording, ...]

    @property
    def model(self) -> Model:
        """The model with the fitted parameters."""
        return Model.of(self.found.fitted.model)

    @property
    def rmse(self) -> float:
        """Error on the data that were fitted, in the measured unit."""
        return self.found.fitted.rmse

    @property
    def title(self) -> str:
        """What was identified from what."""
        return f"{self.found.model.actuator.name}, identified from {', '.join(each.name for each in self.recordings)}"

    def to_json(self) -> str:
        """The content of identification.json."""
        return json.dumps(self.found.as_mapping(), indent=1, allow_nan=False) + "\n"

    def figure(self) -> go.Figure:
        """Fit, residual and input over the time of all recordings, as a Plotly figure."""
        from pierburg_ros.identification.plot import figure

        return figure(self.found, self.recordings)

    def picture(self) -> Figure:
        """The fit of the first recording as a Matplotlib figure."""
        from pierburg_ros.comparison.plot import picture

        first = self.recordings[0]
        return picture(Comparison(first, self.model, first.measured - self.found.fitted.residuals[0]))

    def table(self) -> pandas.DataFrame:
        """One row a parameter: value, unit, ends of the 95 % interval (None where there is none), what is known."""
        entries = self.found.as_mapping()["parameters"]
        intervals = [entry["ci95"] or (None, None) for entry in entries.values()]
        return data_frame(
            {
                "parameter": list(entries),
                **{key: [entry[key] for entry in entries.values()] for key in ("value", "unit")},
                "low": [low for low, _ in intervals],
                "high": [high for _, high in intervals],
                **{key: [entry[key] for entry in entries.values()] for key in ("identifiable", "fixed")},
            }
        )

    def rows(self) -> dict[str, str]:
        """Every fitted parameter with its interval, and the errors."""
        unit = self.found.model.actuator.unit
        rows = {}
        for name in self.found.fitted.names:
            entry = self.found.as_mapping()["parameters"][name]
            interval = " ({:.4g} to {:.4g})".format(*entry["ci95"]) if entry["ci95"] else ", not identifiable"
            rows[name] = f"{entry['value']:.4g} {entry['unit']}{interval}"
        rows["RMSE"] = f"{self.rmse:.4g} {unit}, on unseen data {self.found.validation_rmse:.4g} {unit}"
        rows["noise of the measurement"] = f"{self.found.noise:.2g} {unit}"
        return rows

    def write_into(self, folder: Path) -> None:
        """Write identification.json, model.yaml, identification.html, fit.png and static_characteristic.png."""
        from pierburg_ros.identification.page import identification_page
        from pierburg_ros.identification.plot import static_picture
        from pierburg_ros.library.origin import origin

        (folder / "identification.json").write_text(self.to_json(), encoding="utf-8")
        model = folder / "model.yaml"
        self.model.write(model)
        page = identification_page(self.found, self.recordings, *origin(self.model.actuator, self.recordings, model))
        (folder / "identification.html").write_text(page, encoding="utf-8")
        self.picture().savefig(folder / "fit.png", dpi=120)
        if self.found.static is not None:
            drawn = static_picture(self.found.static, self.found.model.actuator.upper_stop)
            drawn.savefig(folder / "static_characteristic.png", dpi=120)


def identify(
    recordings: Readable | Sequence[Readable],
    *,
    actuator: ActuatorLike | None = None,
    model: ModelLike | None = None,
    free: str | Sequence[str] = (),
    fixed: str | Sequence[str] = (),
    jobs: int | None = None,
) -> Identification:
    """The parameters of an actuator that `recordings` show.

    Recordings of one actuator or their paths; the fit starts from `model`, or from `actuator` as described (by
    default the Pierburg valve). `free` and `fixed` name parameters that are fitted too, or held. `jobs` is the
    number of fits at a time, by default one for each core. InputError where a recording shows no motion.

        identification = pr.identify(["bench.mcap"], fixed=["torque_constant"])
        identification.save("results/identified")
    """
    start = chosen_model(model, actuator if actuator or model else "pierburg")
    measured = [part for each in recordings_of(recordings, start.actuator) for part in parts_of(each, start.actuator)]
    return Identification(identified(start, measured, tuple(names(free)), tuple(names(fixed)), jobs), tuple(measured))
