"""The report: one page that needs no network, with every part of the document on it."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from support.reports import LEFT, TIME, diagnosis, result

from pierburg_ros.diagnosis.report.figures import autocorrelation, signal_figure, torque_figure, trend_figure
from pierburg_ros.diagnosis.report.page import headline, write_page
from pierburg_ros.diagnosis.report.page import page as page_of
from pierburg_ros.diagnosis.report.picture import picture
from pierburg_ros.diagnosis.result import Exhibits, View
from pierburg_ros.diagnosis.schema import InputFault
from pierburg_ros.pages.page import Sources


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
        "7.0 % of the mismatch: a slow swing",
        "30.00 to 32.00 s: messages are missing", "more than 900 N.m/rad",
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
    write_page(tmp_path / "report.html", result(), [("command", "pierburg <diagnose>")], Sources([["my run.mcap"]]))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "pierburg &lt;diagnose&gt;" in page
    assert "pierburg replay &#39;my run.mcap&#39; --model model.yaml" in page


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


def test_a_refused_recording_is_shown_without_any_model():
    """Nothing is simulated of signals at fault, so nothing may look like a model that fits."""
    plain = result(
        input_faults=[InputFault(recording="a", signal="duty", what="turned", evidence="so", mend="sign: -1")]
    )
    nothing = dict.fromkeys(("nominal", "recalibrated", "final"), np.full(TIME.size, np.nan))
    refused = replace(plain, signals={**plain.signals, **nothing}, exhibits=Exhibits())
    written = page_of(refused)
    plot = json.loads(re.search(r'data-plot="time-0">(.*?)</script>', written).group(1))
    assert {trace["meta"]["label"] for trace in plot["data"]} == {"measured", "input"}
    assert "nothing is concluded" in written and "sign: -1" in written
