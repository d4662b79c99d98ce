"""The report: one page that needs no network, with every part of the document on it."""

from types import SimpleNamespace

import numpy as np
import pytest

from pierburg_ros.diagnosis.report.figures import BUCKETS, signal_figure, thinned, torque_figure
from pierburg_ros.diagnosis.report.page import headline, picture, write_page
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Candidate,
    Change,
    DataQuality,
    Diagnosis,
    Effect,
    Errors,
    Estimate,
    FitQuality,
    Location,
    NotTestable,
    Regime,
    ResidualTorque,
    TorqueOverTime,
)

TIME = 0.002 * np.arange(30000)


def diagnosis(**changes) -> Diagnosis:
    errors = Errors(nominal_rmse=0.2, recalibrated_rmse=0.07, final_rmse=0.0042)
    breakaway = Estimate(value=0.27, unit="N.m", ci95=(0.26, 0.28), identifiable=True)
    preload = BaseParameter(nominal=0.29, value=0.33, unit="N.m", ci95=None, identifiable=True, drifted=True)
    fields = {
        "recordings": ["train<1>.mcap"],
        "quantity": "hall_voltage",
        "unit": "V",
        "verdict": "missing_physics",
        "summary": "The model lacks static friction.",
        "effects": [
            Effect(
                id="static_friction",
                confidence=0.99,
                parameters={"breakaway_torque": breakaway},
                indistinguishable_from=[["armature_resistance", "torque_constant"]],
                explanation="It sticks harder than it slides.",
            )
        ],
        "parameters": {"spring_preload": preload},
        "changes": [Change(parameter="supply_voltage", time=31.2, before=13.5, after=12.9)],
        "locations": [Location(start=12.1, end=12.6, share=0.08, regime="leaving the closed stop")],
        "regimes": [Regime(variable="angle", range=(0.0, 0.5), unit="rad", share_of_residual=0.74, share_of_time=0.09)],
        "fit": FitQuality(noise_floor=0.004, training=errors, validation=errors),
        "candidates": [Candidate(id="backlash", validation_rmse=0.06, evidence=12.0, status="rejected")] * 20,
        "not_testable": [NotTestable(id="backlash", why="the flanks never part", record="duty below 0")],
        "data_quality": DataQuality(
            rate=500.0,
            jitter=0.0,
            gaps=0,
            saturated_share=0.0,
            stops_touched=["closed"],
            excited="angle 0 to 83 degrees",
        ),
        "advice": ["Log the supply voltage."],
    }
    return Diagnosis(**{**fields, **changes})


def result(**changes) -> SimpleNamespace:
    measured = 2.0 + np.sin(TIME)
    signals = {"time": TIME, "measured": measured, "command": 0.1 * np.sin(TIME)}
    signals |= dict.fromkeys(("nominal", "recalibrated", "final"), measured + 0.1)
    return SimpleNamespace(diagnosis=diagnosis(**changes), signals=signals)


LEFT = ResidualTorque(
    angle=[0.0, 1.0],
    velocity=[-1.0, 1.0],
    torque=[[0.01, 0.02], [0.0, -0.03]],
    shape="up to 0.03 N.m that opens",
    over_time=TorqueOverTime(time=[1.0, 2.0], torque=[0.01, None]),
)


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> str:
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_page(path, result())
    return path.read_text(encoding="utf-8")


def test_page_is_whole_small_and_needs_no_network(page):
    assert len(page) < 6e6
    head = page.split("plotly.js v")[0] + page[page.rfind("</script>") :]
    assert "src=" not in head and "cdn." not in head
    assert page.count("plotly.js v") == 1


@pytest.mark.parametrize(
    "text",
    [
        "static friction", "0.26 to 0.28", "armature resistance with torque constant", "leaving the closed stop",
        "0 to 28.6 degrees", "74 %", "spring preload", "supply voltage", "the flanks never part", "8 more",
        "Log the supply voltage.", "angle 0 to 83 degrees", "train&lt;1&gt;.mcap", "0.0042",
    ],
)  # fmt: skip
def test_page_shows_every_part(page, text):
    assert text in page


def test_page_of_something_unexplained_shows_the_torque(tmp_path):
    write_page(tmp_path / "report.html", result(verdict="unexplained", effects=[], residual_torque=LEFT))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "up to 0.03 N.m that opens" in page and page.count("plotly.js v") == 1
    surface, trend = torque_figure(LEFT).data
    assert np.shape(surface.z) == (2, 2) and surface.z[1][0] == 0.02
    assert trend.y[1] is None


def test_figure_shades_and_numbers_the_windows():
    drawn = signal_figure(diagnosis(), result().signals)
    windows = [shape for shape in drawn.layout.shapes if shape.x0 == 12.1]
    assert len(windows) == 4 and all(shape.x1 == 12.6 for shape in windows)
    assert "1" in [note.text for note in drawn.layout.annotations]


def test_thinning_loses_no_peak():
    values = np.zeros(TIME.size)
    values[12345], values[12346] = 5.0, -7.0
    time, kept = thinned(TIME, values)
    assert time.size <= 2 * BUCKETS + 2 and np.all(np.diff(time) > 0.0)
    assert kept.max() == 5.0 and kept.min() == -7.0
    assert time[np.argmax(kept)] == TIME[12345]


def test_headline_names_effects_and_drifts():
    assert headline(diagnosis()) == "train<1>.mcap: missing physics: static friction and spring preload"


def test_picture_is_a_png(tmp_path):
    picture(result()).savefig(tmp_path / "overview.png", dpi=110)
    assert (tmp_path / "overview.png").read_bytes().startswith(b"\x89PNG")


def test_names_from_files_are_text_on_page_and_picture(tmp_path):
    name = "<script>alert(1)</script>$\\frac$"
    hostile = result(recordings=[name], summary=name, advice=[name])
    write_page(tmp_path / "report.html", hostile)
    assert "<script>alert" not in (tmp_path / "report.html").read_text()
    picture(hostile).savefig(tmp_path / "overview.png")
