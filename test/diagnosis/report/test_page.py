"""The report: one page that needs no network, with every part of the document on it."""

import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.report.figures import autocorrelation, signal_figure, torque_figure, trend_figure
from pierburg_ros.diagnosis.report.page import headline, write_page
from pierburg_ros.diagnosis.report.picture import picture
from pierburg_ros.diagnosis.result import Characteristic, Exhibits, Result, Tried, View
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
from pierburg_ros.plant import Model

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


def result(drawn: int = 5, **changes) -> Result:
    """A result with `drawn` rivals of which the page has the signals, and two recordings."""
    measured = 2.0 + np.sin(TIME)
    signals = {"time": TIME, "measured": measured, "duty": 0.1 * np.sin(TIME)}
    signals |= dict.fromkeys(("nominal", "recalibrated", "final"), measured + 0.1)
    said = diagnosis(**changes)
    rivals = [Tried(f"rival_{n}", 1, "tied" if n == 0 else "rejected", 0.01, 0.02, 5.0 * n, f"rival-{n}") for n in range(drawn)]
    tried = (Tried("static_friction", 1, "chosen", 0.004, 0.0042, 0.0, "final"), *rivals)
    keys = ["nominal", "recalibrated", "final", *(row.key for row in rivals)]
    views = tuple(view(name, keys) for name in said.recordings)
    curves = {key: (TIME[:50], TIME[:50]) for key in keys[:3]}
    law = Characteristic("friction", "friction", "velocity [rad/s]", "torque [N.m]", curves, (TIME[:9], TIME[:9]))
    model = Model.nominal(read_actuator("pierburg"))
    return Result(said, model, (), signals, Exhibits(views, tried, (law,)))


def view(name: str, keys: list[str]) -> View:
    """A minute at 500 Hz less a gap of two seconds, with errors like noise."""
    random = np.random.default_rng(1)
    there = (TIME < 30.0) | (TIME > 32.0)
    time = TIME[there]
    errors = {key: 0.003 * random.standard_normal(time.size) for key in keys}
    state = np.sin(time)
    return View(name, time, 2.0 + state, 0.1 * state, state, np.cos(time), errors, ((30.0, 32.0, "messages are missing"),))


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
    """6 MiB for a minute at 500 Hz with everything drawn; its own policy forbids it any address."""
    assert len(page.encode()) < 6 * 2**20
    head = page.split("plotly.js v")[0] + page[page.rfind("</script>") :]
    assert "src=" not in head and "default-src 'none'" in head
    assert page.count("plotly.js v") == 1
    assert page.index("plotly.js v") < page.index("data-plot")


class Names(HTMLParser):
    """Names of elements, and which are referred to."""

    def __init__(self) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.wanted: list[str] = []

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.ids += [values["id"]] if "id" in values else []
        self.wanted += [values[name] for name in ("data-zoom", "data-copy", "data-plot") if name in values]
        if values.get("href", "").startswith("#"):
            self.wanted.append(values["href"][1:])


def test_every_link_and_button_leads_to_a_part_of_the_page(page):
    names = Names()
    names.feed(page)
    assert len(names.ids) == len(set(names.ids)) and len(names.wanted) > 10
    assert set(names.wanted) <= set(names.ids)


def test_every_curve_over_time_has_its_signals(page):
    signals = json.loads(re.search(r'id="signals">(.*?)</script>', page).group(1))
    plots = re.findall(r'<script type="application/json" data-plot="time-\d">(.*?)</script>', page)
    traces = [trace["meta"] for plot in plots for trace in json.loads(plot)["data"]]
    assert traces and all({meta["time"], meta["plus"], meta.get("minus", "0/time")} <= set(signals) for meta in traces)


@pytest.mark.parametrize(
    "text",
    [
        "static friction", "0.260 to 0.280", "armature resistance with torque constant", "leaving the closed stop",
        "0 to 28.6 degrees", "74 %", "spring preload", "supply voltage", "the flanks never part", "rival 4", "tied",
        "Log the supply voltage.", "angle 0 to 83 degrees", "train&lt;1&gt;.mcap", "0.0042",
    ],
)  # fmt: skip
def test_page_shows_every_part(page, text):
    assert text in page


def test_page_of_something_unexplained_shows_the_torque(tmp_path):
    write_page(tmp_path / "report.html", result(verdict="unexplained", effects=[], residual_torque=LEFT))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "up to 0.03 N.m that opens" in page and page.count("plotly.js v") == 1
    (surface,), (trend,) = torque_figure(LEFT).data, trend_figure(LEFT).data
    assert np.shape(surface.z) == (2, 2) and surface.z[1][0] == 0.02
    assert trend.y[1] is None


def test_origin_is_told_and_commands_can_be_copied(tmp_path):
    write_page(tmp_path / "report.html", result(), [("command", "pierburg <diagnose>")], [tmp_path / "my run.mcap"])
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "pierburg &lt;diagnose&gt;" in page
    assert f"pierburg replay &#39;{tmp_path / 'my run.mcap'}&#39; --model model.yaml" in page


def test_autocorrelation_of_a_decaying_error_is_its_decay():
    """An error e[k] = a e[k-1] + w has autocorrelation a^n (Box, Jenkins, Time series analysis (1976), section 3.2)."""
    random, share = np.random.default_rng(2), 0.95
    error = np.zeros(TIME.size)
    for k in range(1, error.size):
        error[k] = share * error[k - 1] + random.standard_normal()
    nothing = np.zeros(TIME.size)
    seen = View("run", TIME, nothing, nothing, nothing, nothing, {"final": error})
    lag, correlation, samples = autocorrelation([seen], "final")
    assert samples == TIME.size
    # Bartlett: the standard deviation of the estimate stays below sqrt((1 + a^2) / (1 - a^2) / n) = 0.026
    np.testing.assert_allclose(correlation, share ** (lag / 0.002), atol=4 * 0.026)


def test_figure_shades_and_numbers_the_windows():
    drawn = signal_figure(diagnosis(), result().signals)
    windows = [shape for shape in drawn.layout.shapes if shape.x0 == 12.1]
    assert len(windows) == 4 and all(shape.x1 == 12.6 for shape in windows)
    assert "1" in [note.text for note in drawn.layout.annotations]


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
