"""A fleet as a whole: who is found to age, what the tables hold and who opens them, what is not done twice."""

import json
import math
import re
import shlex
from datetime import datetime, timezone
from pathlib import Path

import numpy as np
import pytest
from support.fleets import examined, fleet, limited, named

import pierburg_ros as pr
from pierburg_ros.errors import InputError
from pierburg_ros.fleets.ageing.course import courses
from pierburg_ros.fleets.fleet import checked_limits, units_of
from pierburg_ros.fleets.structure import base_names, own_effects, without_least
from pierburg_ros.fleets.table import COLUMNS

PAGE = Path(__file__).parents[2] / "docs" / "fleet.md"
REFERENCE = PAGE.parent / "reference" / "fleet_tables.md"


@pytest.fixture(scope="module")
def found():
    """Eight units of which one ages and one steps, with a limit."""
    return fleet(limits={"armature_resistance": 5.0})


def test_who_ages_steps_and_differs_is_found_and_nobody_else(found):
    known = {each.course.unit_name: each for each in found.ageing}
    assert [name for name, each in known.items() if each.changes] == ["valve-000"]
    assert [name for name, each in known.items() if each.stepped] == ["valve-001"]
    assert {name for name, each in known.items() if each.differs} == {"valve-000", "valve-001"}
    rise, step = known["valve-000"].line, known["valve-001"].step
    assert rise.interval[0] < 0.6 / 365.0 < rise.interval[1]
    assert step.interval[0] < 0.3 < step.interval[1]


def test_a_sentence_says_whom_to_look_at_first_and_why(found):
    assert re.fullmatch(
        r"Look at valve-000 first: its armature resistance rises by 0\.0\d+ ohm a month \(95 %: .*\) and reaches 5 ohm"
        r" about 2026-0\d-\d\d \(95 %: 2026-.* to 2026-.*\) if all goes on as before\.",
        found.sentence,
    )
    assert [each.unit for each in found.attention[:2]] == ["valve-000", "valve-001"]


def test_where_nothing_changes_the_sentence_says_so():
    quiet = fleet()
    steady = [each for each in quiet.recordings if each.source.unit not in ("valve-000", "valve-001")]
    said = pr.fleets.fleet.fleet_of(steady, quiet.nominal, {}).sentence
    assert said.startswith("No unit stands out")


def test_two_units_with_a_recording_each_are_ranked_by_their_last_verdict():
    worn = {"verdict": "missing_physics", "findings": [named(0.02)], "nominal_rmse": 0.1}
    made = [
        examined("healthy", 0, 4.139, 0.0),
        examined("worn", 0, 4.139, 0.0, **worn),
        examined("repaired", 0, 4.139, 0.0, **worn),
        examined("repaired", 1, 4.139, 30.0),
    ]
    of = pr.fleets.fleet.fleet_of
    pair = of(made[:2], pr.Model.nominal("pierburg"), {})
    assert pair.sentence == (
        "Look at worn first: its last diagnosis says missing physics: backlash; as described the error is 50 times the"
        " noise."
    )
    found = of(made, pair.nominal, {}).attention
    assert [(each.unit, each.kind) for each in found] == [
        ("worn", "its verdict"),
        ("healthy", "nothing stands out"),
        ("repaired", "nothing stands out"),
    ]


def test_a_unit_of_which_nothing_can_be_read_or_trusted_comes_before_a_healthy_one():
    made = [examined("healthy", 0, 4.139, 0.0), examined("turned", 0, 4.139, 0.0, faults=["duty: turned"])]
    bad = type(made[0])(made[0].source.__class__("/runs/bad/0.mcap", "bad"), "", {"problem": "none"}, {})
    found = pr.fleets.fleet.fleet_of([*made, bad], pr.Model.nominal("pierburg"), {}).attention
    assert {each.unit for each in found[:2]} == {"turned", "bad"}


def test_limits_that_are_ruled_out_count_as_the_range_they_leave():
    early = [examined("a", k, 4.1, 30.0 * k, findings=[limited(0.006)]) for k in range(3)]
    gap = {"backlash.gap": {"value": 0.02, "deviation": 0.001, "determined": True}}
    late = examined("a", 3, 4.1, 90.0, findings=[named(0.02)])
    late = type(late)(late.source, late.key, late.result, {**late.measured, **gap})
    nominal = pr.Model.nominal("pierburg")
    play = next(each for each in courses([*early, late], nominal.values, units_of(nominal)) if "." in each.quantity)
    assert play.value == pytest.approx([0.003, 0.003, 0.003, 0.02])
    assert play.deviation == pytest.approx([0.006 / math.sqrt(12.0)] * 3 + [0.001])
    assert play.limited.tolist() == [True, True, True, False]


def test_of_an_effect_that_no_diagnosis_of_the_unit_names_there_is_no_course():
    nominal = pr.Model.nominal("pierburg")
    made = courses(
        [examined("a", k, 4.1, k, findings=[limited(0.006)]) for k in range(3)], nominal.values, units_of(nominal)
    )
    assert [each.quantity for each in made] == ["armature_resistance"]


def test_the_common_model_has_what_diagnoses_change_and_recordings_determine():
    drift = {"kind": "parameter", "name": "armature_resistance", "value": 4.4}
    other = {"kind": "parameter", "name": "torque_constant", "value": 0.02}
    assert base_names([[drift], [drift, other], [drift, other], []]) == ("armature_resistance", "torque_constant")
    assert base_names([[drift], [drift, other]]) == ("armature_resistance",)
    assert own_effects([drift, named(0.03)]) == ({"backlash.gap": 0.03}, ("backlash.gap",))
    assert without_least(("a", "b"), {"a": 1.0, "b": 0.4}) == ("a",)
    assert without_least(("a", "b"), {"a": 1.0, "b": 0.6}) == ("a", "b")
    assert without_least(("a", "b", "c"), {"a": 0.1, "b": 0.1, "c": 1.0}) == ("a", "c")
    assert without_least(("a",), {"a": 0.1}) == ()


def test_a_limit_of_something_without_a_course_is_refused():
    with pytest.raises(InputError, match="--limit found resistance"):
        checked_limits({"resistance": 5.0}, pr.Model.nominal("pierburg"))


@pytest.mark.parametrize("name", list(COLUMNS))
def test_a_table_has_the_columns_that_the_reference_lists(found, name):
    rows = found.rows(name)
    assert rows and all(list(row) == list(COLUMNS[name]) or set(row) == set(COLUMNS[name]) for row in rows)
    text = REFERENCE.read_text(encoding="utf-8")
    for column, (kind, meaning) in COLUMNS[name].items():
        assert f"| `{column}` | {kind} | {meaning} |" in text


@pytest.fixture(scope="module")
def written(found, tmp_path_factory):
    """The files of a fleet."""
    pytest.importorskip("pyarrow", reason="needs pyarrow")
    folder = tmp_path_factory.mktemp("fleet")
    found.write_into(folder)
    return folder


def queries():
    """The example queries of the page, by the library that they need."""
    return re.findall(r"```python\n# (\w+)\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.mark.parametrize(("library", "code"), queries(), ids=[library for library, _ in queries()])
def test_the_tables_open_where_the_page_says(written, library, code, monkeypatch):
    pytest.importorskip(library, reason=f"needs {library}")
    monkeypatch.chdir(written.parent)
    if not Path("fleet").exists():
        Path("fleet").symlink_to(written)
    names = {}
    exec(compile(code, "<page>", "exec"), names)
    assert "valve-000" in str(names["shown"])


def test_parquet_holds_units_and_meanings(written):
    from pyarrow import parquet

    table = parquet.read_table(written / "ageing.parquet")
    assert table.schema.field("slope").metadata[b"meaning"] == b"change a day"
    rows = {row["unit"]: row for row in table.to_pylist()}
    assert rows["valve-000"]["limit_time"] > datetime(2026, 1, 1, tzinfo=timezone.utc)
    bad = [row for row in parquet.read_table(written / "recordings.parquet").to_pylist() if row["problem"]]
    assert [row["recording"] for row in bad] == ["/runs/valve-002/bad.mcap"]
    content = json.loads((written / "fleet.json").read_text())
    assert content["unusable"] == 1 and content["units"][0]["unit"] == "valve-000"


@pytest.mark.search
def test_recordings_are_diagnosed_once_and_a_bad_one_is_a_row(tmp_path):
    pytest.importorskip("pyarrow", reason="needs pyarrow")
    time = np.arange(0.0, 10.0, 0.004)
    duty = np.choose((time / 1.25).astype(int) % 4, [0.0, 0.24, 0.3, 0.1])
    for number, resistance in enumerate((4.139, 4.6)):
        worn = pr.Model.nominal("pierburg").with_values({"armature_resistance": resistance})
        made = pr.simulate(worn, duty=duty, time=time, noise=0.003, seed=number)
        made.save(tmp_path / "runs" / "ab"[number] / f"2026-0{number + 1}-01")
    (tmp_path / "runs" / "c" / "2026-03-01").mkdir(parents=True)
    (tmp_path / "runs" / "c" / "2026-03-01" / "simulated.mcap").write_bytes(b"nothing")
    told = []

    def run():
        told.clear()
        tell = lambda stage, done, total, last: told.append((stage, done, total))  # noqa: E731
        return pr.fleet(
            tmp_path / "runs", tmp_path / "out", pattern="{unit}/{date}/*", jobs=2, budget=20.0, progress=tell
        )

    first = run()
    assert [each.result.get("verdict") for each in first.recordings] == ["consistent", "parameter_drift", None]
    assert "is not an MCAP file" in first.recordings[2].problem
    assert [each.unit for each in first.attention] == ["c", "b", "a"]
    assert first.attention[1].why.startswith(
        "its last diagnosis says parameter drift: armature resistance; as described"
    )
    assert told.count(("diagnosing", 3, 3)) == 1
    reports = [row["report"] for row in first.rows("recordings")]
    assert reports[2] is None and all((tmp_path / "out" / report).exists() for report in reports[:2])
    page = (tmp_path / "out" / reports[1]).read_text()
    assert not page.count("Plotly.js v")
    replay = shlex.split(re.search(r"pierburg replay [^<]+", page)[0])
    assert float(pr.Model.read(replay[replay.index("--model") + 1]).values["armature_resistance"]) > 4.4
    assert replay[2] == first.recordings[1].source.path
    stamps = {path: path.stat().st_mtime_ns for path in (tmp_path / "out" / "recordings").rglob("*")}
    second = run()
    assert second.rows("recordings") == first.rows("recordings")
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "out" / "recordings").rglob("*")} == stamps
