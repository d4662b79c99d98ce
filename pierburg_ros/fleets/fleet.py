"""A fleet from its recordings to its tables and its page."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pierburg_ros.actuators.values import check
from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.effects import DECLARED
from pierburg_ros.errors import InputError, near
from pierburg_ros.fleets.ageing.ageing import Ageing, ageing
from pierburg_ros.fleets.ageing.attention import Attention, ranked
from pierburg_ros.fleets.ageing.course import DAY, courses, is_strength, moment
from pierburg_ros.fleets.page import fleet_page
from pierburg_ros.fleets.recordings.units import sources
from pierburg_ros.fleets.run import Examined, Report, Where, conduct
from pierburg_ros.fleets.store import RECORDINGS, Store
from pierburg_ros.fleets.table import ageing_rows, finding_rows, recording_rows, require_parquet, write_parquet
from pierburg_ros.fleets.task import Task
from pierburg_ros.intake import path_of
from pierburg_ros.library.model import ActuatorLike, ModelLike, chosen_model
from pierburg_ros.library.output import write_whole
from pierburg_ros.library.tables import data_frame
from pierburg_ros.plant import Model
from pierburg_ros.recording.signal_map import signal_map

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Fleet:
    """Every recording of a fleet as diagnosed and measured, and the ageing of its units, the most urgent first."""

    nominal: Model
    recordings: tuple[Examined, ...]
    ageing: tuple[Ageing, ...]
    attention: tuple[Attention, ...]

    def __repr__(self) -> str:
        return f"Fleet({len(self.recordings)} recordings of {len(self.attention)} units. {self.sentence})"

    @property
    def sentence(self) -> str:
        """Which unit to look at first, and why."""
        first = self.attention[0]
        if first.urgency[0] == 0:
            return f"No unit stands out: {first.why}."
        return f"Look at {first.unit} first: {first.why}."

    def table(self, name: str = "recordings") -> pandas.DataFrame:
        """The table `recordings`, `findings` or `ageing` as a data frame; columns in docs/reference/fleet_tables.md."""
        rows = self.rows(name)
        return data_frame({column: [row[column] for row in rows] for column in (rows[0] if rows else {})})

    def rows(self, name: str) -> list[dict[str, Any]]:
        """The rows of a table; InputError where there is no such table."""
        if name == "recordings":
            return recording_rows(self.recordings)
        if name == "findings":
            return finding_rows(self.recordings, units_of(self.nominal))
        if name == "ageing":
            return ageing_rows(self.ageing)
        raise InputError(f"found table {name!r}, expected recordings, findings or ageing.")

    def to_json(self) -> str:
        """The content of fleet.json."""
        content = {
            "schema": 1,
            "recordings": len(self.recordings),
            "unusable": sum(each.problem is not None for each in self.recordings),
            "undated": sum(each.problem is None and moment(each) is None for each in self.recordings),
            "first": self.sentence,
            "units": [{"unit": each.unit, "why": each.why} for each in self.attention],
        }
        return json.dumps(content, indent=1, allow_nan=False) + "\n"

    def write_into(self, folder: Path) -> None:
        """Write fleet.html, fleet.json and the three tables."""
        from plotly.offline import get_plotlyjs

        for name in ("recordings", "findings", "ageing"):
            write_parquet(folder / f"{name}.parquet", name, self.rows(name))
        write_whole(folder / "fleet.json", self.to_json())
        if not (folder / "plotly.min.js").exists():
            write_whole(folder / "plotly.min.js", get_plotlyjs())
        page = fleet_page(self.recordings, self.ageing, self.attention, self.sentence, self.nominal.actuator)
        write_whole(folder / "fleet.html", page)


def fleet(
    where: str | Path,
    output: str | Path,
    *,
    actuator: ActuatorLike | None = None,
    model: ModelLike | None = None,
    pattern: str | None = None,
    limits: Mapping[str, float] | None = None,
    signals: str | Path | Mapping[str, Any] | None = None,
    topics: Mapping[str, str] | None = None,
    time: str | None = None,
    budget: Budget | float | str | None = USUAL_BUDGET,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Report | None = None,
) -> Fleet:
    """Diagnose the recordings of many units, follow every quantity over the life of each, say who to look at first.

    `where` is a folder, a glob or a table (CSV, Parquet: recording, unit, time), on this machine or any path that
    fsspec reads. `pattern`, as in `{unit}/{date}_*.mcap`, says unit and date; otherwise the unit is the folder and the
    time the bag's own. `limits` by quantity, as in `armature_resistance`, in its unit: when each unit reaches them.
    Work is done by `jobs` processes, or on the workers of a Dask `scheduler` (`tcp://host:port`). Results are kept in
    the folder `output`; what has one of the same recording, model and version is not done again. A recording that
    cannot be used is a row with its reason. InputError where nothing can be begun.

        fleet = pr.fleet("recordings", "fleet", limits={"armature_resistance": 5.0})
        print(fleet.sentence)
        fleet.table("ageing")
    """
    require_parquet()
    folder = path_of(output, "the folder for the results")
    nominal = chosen_model(model, actuator if actuator or model else "pierburg")
    stated = checked_limits(limits or {}, nominal)
    found = sources(str(where), pattern)
    task = Task(nominal, Budget.of(budget), folder / RECORDINGS, time, signal_map(signals, topics or {}))
    store = Store(folder)
    examined = conduct(found, task, store, Where(jobs, scheduler), progress or (lambda *_: None))
    made = fleet_of(examined, nominal, stated)
    made.write_into(folder)
    return made


def fleet_of(examined: Sequence[Examined], nominal: Model, limits: Mapping[str, float]) -> Fleet:
    """What the recordings of a fleet say together; forecasts begin with the last of them."""
    dated = [when.timestamp() / DAY for each in examined if not each.problem and (when := moment(each)) is not None]
    found = ageing(courses(examined, nominal.values, units_of(nominal)), limits, max(dated, default=0.0))
    return Fleet(nominal, tuple(examined), tuple(found), tuple(ranked(examined, found)))


def units_of(nominal: Model) -> dict[str, str]:
    """Unit of every quantity by dotted name."""
    return {name: nominal.actuator.unit_of(name) for name in (*nominal.actuator.parameters, *DECLARED)}


def checked_limits(limits: Mapping[str, float], nominal: Model) -> dict[str, float]:
    """The limits, or InputError where one is of no quantity that has a course."""
    base = list(nominal.actuator.parameters)
    known = [*base, *(name for name in DECLARED if is_strength(name))]
    for name, value in limits.items():
        if name not in known:
            raise InputError(
                f"--limit found {name}, expected a base parameter ({', '.join(base)}) or an effect's strength."
                f"{near(name, known)}"
            )
        try:
            check(nominal.actuator, name, float(value))
        except InputError as error:
            raise InputError(f"--limit: {error}") from None
    return dict(limits)
