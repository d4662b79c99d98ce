"""What a simulation lacks, from recordings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.diagnosis import diagnose as diagnosing
from pierburg_ros.diagnosis.result import Result as Found
from pierburg_ros.diagnosis.schema import BaseParameter, Estimate
from pierburg_ros.diagnosis.schema import Diagnosis as Document
from pierburg_ros.library import overlays
from pierburg_ros.library.model import ActuatorLike, Model, ModelLike, chosen_model
from pierburg_ros.library.reading import Readable, recordings_of
from pierburg_ros.library.result import Result
from pierburg_ros.library.tables import data_frame
from pierburg_ros.recording import Recording
from pierburg_ros.viewers.mcap_overlay import write_mcap
from pierburg_ros.viewers.rerun_overlay import write_rerun
from pierburg_ros.workers import one_thread

if TYPE_CHECKING:
    import pandas
    import plotly.graph_objects as go
    from matplotlib.figure import Figure

Progress = Callable[[str], None]


@dataclass(frozen=True, repr=False, eq=False)
class Diagnosis(Result):
    """The verdict on recordings; `document` has every field of diagnosis.json, `found` the signals as well."""

    found: Found
    recordings: tuple[Recording, ...] = ()

    @property
    def document(self) -> Document:
        """All that diagnosis.json says, field by field."""
        return self.found.diagnosis

    @property
    def verdict(self) -> str:
        """consistent, parameter_drift, missing_physics or unexplained."""
        return self.document.verdict

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that are named."""
        return tuple(effect.id for effect in self.document.effects)

    @property
    def model(self) -> Model:
        """The corrected model."""
        return Model.of(self.found.model)

    @property
    def title(self) -> str:
        """Recordings, verdict and names."""
        from pierburg_ros.diagnosis.report.page import headline

        return headline(self.document)

    def to_json(self) -> str:
        """The content of diagnosis.json."""
        return self.document.text()

    def figure(self) -> go.Figure:
        """Signals, errors before and after, and duty of the first recording, as a Plotly figure."""
        from pierburg_ros.diagnosis.report.figures import signal_figure

        return signal_figure(self.document, self.found.signals)

    def picture(self) -> Figure:
        """The same as a Matplotlib figure."""
        from pierburg_ros.diagnosis.report.picture import picture

        return picture(self.found)

    def table(self) -> pandas.DataFrame:
        """One row a quantity that the corrected model changes: value, unit, ends of the 95 % interval, nominal."""
        rows: list[tuple[str, float | None, Estimate | BaseParameter]] = [
            (f"{effect.id}.{name}", None, estimate)
            for effect in self.document.effects
            for name, estimate in effect.parameters.items()
        ]
        parameters = self.document.parameters.items()
        rows += [(name, each.nominal, each) for name, each in parameters if each.drifted]
        intervals = [estimate.ci95 or (None, None) for _, _, estimate in rows]
        return data_frame(
            {
                "quantity": [name for name, _, _ in rows],
                "nominal": [nominal for _, nominal, _ in rows],
                "value": [estimate.value for _, _, estimate in rows],
                "unit": [estimate.unit for _, _, estimate in rows],
                "low": [low for low, _ in intervals],
                "high": [high for _, high in intervals],
                "identifiable": [estimate.identifiable for _, _, estimate in rows],
            }
        )

    def rows(self) -> dict[str, str]:
        """Verdict, summary, and what to record next."""
        rows = {"verdict": self.verdict.replace("_", " "), "summary": self.document.summary}
        if self.document.advice:
            rows["next"] = self.document.advice[0]
        return rows

    def write_into(self, folder: Path) -> None:
        """Write diagnosis.json, model.yaml, report.html, overview.png, and a diagnosis.mcap for each recording.

        Of several recordings they are diagnosis_1.mcap and so on, in their order; none where nothing is concluded.
        """
        from pierburg_ros.diagnosis.report.model_file import model_text
        from pierburg_ros.diagnosis.report.page import write_page
        from pierburg_ros.library.origin import origin

        self.document.write(folder / "diagnosis.json")
        model = folder / "model.yaml"
        model.write_text(model_text(self.found), encoding="utf-8")
        write_page(folder / "report.html", self.found, *origin(self.model.actuator, self.recordings, model))
        self.picture().savefig(folder / "overview.png", dpi=110)
        laid = overlays.of_diagnosis(self.found, self.recordings)
        for number, overlay in enumerate(laid, 1):
            name = f"diagnosis_{number}.mcap" if len(laid) > 1 else "diagnosis.mcap"
            write_mcap(folder / name, overlay)

    def write_rerun(self, path: str | Path) -> None:
        """Write all recordings to one file for the Rerun viewer; InputError where rerun-sdk is not installed."""
        write_rerun(Path(path), overlays.of_diagnosis(self.found, self.recordings))


def diagnose(
    recordings: Readable | Sequence[Readable],
    *,
    actuator: ActuatorLike | None = None,
    model: ModelLike | None = None,
    simulation: Readable | Sequence[Readable] | None = None,
    progress: Progress | None = None,
    jobs: int | None = None,
    budget: Budget | float | str | None = USUAL_BUDGET,
    force: bool = False,
) -> Diagnosis:
    """Where `recordings` and a model part, which physics is missing, how sure that is, and the corrected model.

    Recordings of one actuator or their paths; compared with `model`, or with `actuator` as described (by default
    the Pierburg valve). Recordings that your own simulator made of the same actuator, as `simulation`, stand for the
    model: the actuator's parameters are first fitted to them, and the diagnosis says how well. `progress` is told in
    words what is being tried, one call at a time. `jobs` is the number of fits at a time, by default one for each core.
    Takes seconds to a minute: after so many usual efforts (`budget`), or Ctrl-C, the best verdict yet is given and
    marked as such; None takes what it takes, and "60s" ends by the clock. Where signals are not what they
    are read as, nothing is concluded, and
    `document.input_faults` says so; `force` goes on. InputError where a recording cannot be used.

        diagnosis = pr.diagnose(["bench.mcap"], actuator="pierburg")
        print(diagnosis.verdict, diagnosis.effects)
        diagnosis.save("results/diagnosis")
    """
    nominal = chosen_model(model, actuator if actuator or model else "pierburg")
    measured = recordings_of(recordings, nominal.actuator)
    simulated = () if simulation is None else recordings_of(simulation, nominal.actuator)
    tell = one_at_a_time(progress or (lambda _: None))
    with one_thread():
        found = diagnosing.diagnose(measured, nominal, tell, jobs, Budget.of(budget), simulated, force)
    return Diagnosis(found, (*measured, *simulated))


def one_at_a_time(progress: Progress) -> Progress:
    """`progress` for several threads: the others wait while it is told something."""
    lock = Lock()

    def tell(what: str) -> None:
        with lock:
            progress(what)

    return tell
