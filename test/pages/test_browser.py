"""The three pages in a real browser: all is drawn, nothing is complained of, nothing is fetched, nothing sticks out."""

import io
import re
from pathlib import Path
from types import SimpleNamespace

import matplotlib.image
import numpy as np
import pytest
from support.browser import NEEDS_BROWSER, Page, browser
from support.reports import LEFT, result

from pierburg_ros.actuators import read_actuator
from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.comparison.page import replay_page
from pierburg_ros.diagnosis.report.page import write_page
from pierburg_ros.identification.page import identification_page
from pierburg_ros.pages.page import Sources
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

pytestmark = NEEDS_BROWSER

TIME = 0.002 * np.arange(5000)
DRAWN = 0.002
"""Share of a plot's pixels that differ from its background, at least: a frame and a curve of a pixel's width."""


@pytest.fixture(scope="module")
def pages(tmp_path_factory) -> Path:
    """report.html of something unexplained in two recordings, replay.html and identification.html."""
    folder = tmp_path_factory.mktemp("pages")
    several = {"recordings": ["first.mcap", "second <b>.mcap"]}
    write_page(
        folder / "report.html",
        result(verdict="unexplained", residual_torque=LEFT, **several),
        [("a", "b")],
        Sources([[str(folder)]]),
    )
    noise = 0.003 * np.random.default_rng(1).standard_normal(TIME.size)
    recording = Recording(
        "run.mcap", "hall_voltage", TIME, 2.0 + np.sin(TIME) + noise, Channel(TIME, 0.1 * np.sin(TIME))
    )
    model = Model.nominal(read_actuator("pierburg"))
    comparison = Comparison(recording, model, 2.0 + np.sin(TIME))
    (folder / "replay.html").write_text(
        replay_page(comparison, {"RMSE": "0.003 V"}, [("a", "b")], Sources([[str(folder)]]))
    )
    names = ("armature_resistance", "torque_constant")
    content = {
        "parameters": {
            name: {"value": 1.0, "unit": "V", "ci95": [0.9, 1.1], "identifiable": True, "fixed": False}
            for name in names
        },
        "lumps": None,
        "static_characteristic": None,
    }
    fitted = SimpleNamespace(residuals=[noise, noise], names=names, correlation=np.eye(2), rmse=0.003, model=model)
    found = SimpleNamespace(
        fitted=fitted, static=None, model=model, noise=0.003, validation_rmse=0.003, as_mapping=lambda: content
    )
    (folder / "identification.html").write_text(identification_page(found, [recording, recording]))
    return folder


@pytest.fixture(scope="module", params=[1400, 400], ids=["wide", "phone"])
def opened(request, tmp_path_factory):
    """A browser as wide as a screen or as a phone."""
    with browser(tmp_path_factory.mktemp("browser"), request.param) as page:
        yield page


def drawn_share(page: Page, element: str) -> float:
    """Share of the pixels of an element that are not its commonest colour."""
    pixels = (255 * matplotlib.image.imread(io.BytesIO(page.picture(element)))[..., :3]).astype(np.uint8)
    colours = pixels.astype(np.uint32) @ np.array([65536, 256, 1], dtype=np.uint32)
    return 1.0 - np.unique(colours, return_counts=True)[1].max() / colours.size


@pytest.mark.parametrize("name", ["report", "replay", "identification"])
def test_every_plot_draws_and_nothing_is_wider_than_the_window(pages, opened, name):
    opened.open(pages / f"{name}.html")
    opened.run("for (const each of document.querySelectorAll('details')) each.open = true")
    opened.wait("return [...document.querySelectorAll('.drawing')].every((each) => each.querySelector('svg.main-svg'))")
    plots = opened.elements(".drawing")
    assert plots and all(drawn_share(opened, plot) > DRAWN for plot in plots)
    curves = opened.run(
        "return [...document.querySelectorAll('.drawing')].map((each) => each.querySelectorAll('path').length)"
    )
    assert min(curves) > 2
    assert opened.run("return document.documentElement.scrollWidth <= innerWidth")
    assert opened.run("return performance.getEntriesByType('resource').length") == 0
    assert opened.errors() == []


def test_a_click_zooms_and_a_tick_switches_an_explanation_on(pages, opened):
    opened.open(pages / "report.html")
    shown = "const plot = document.getElementById('time-0'); return "
    before = opened.run(shown + "plot.layout.xaxis.range")
    inside = "plot.data[0].x.filter((time) => time > 12.1 && time < 12.6).length"
    coarse = opened.run(shown + inside)
    opened.run("document.querySelector('button[data-from]').click()")
    opened.wait(shown + "plot.layout.xaxis.range[0] > 10")
    low, high = opened.run(shown + "plot.layout.xaxis.range")
    assert before[0] < low < 12.1 < 12.6 < high < before[1]
    assert opened.run(shown + inside) > 5 * coarse > 0
    group = "plot.data.filter((trace) => trace.legendgroup === 'rival-0').map((trace) => trace.visible)"
    assert opened.run(shown + group) == [False, False]
    opened.run("document.querySelector('input[data-switch=rival-0]').click()")
    opened.wait(shown + f"{group}.every(Boolean)")
    assert opened.errors() == []


def test_a_button_makes_page_and_plots_dark(pages, opened):
    opened.open(pages / "replay.html")
    ink = (
        "return getComputedStyle(document.querySelector('.drawing text')).fill + getComputedStyle(document.body).color"
    )
    light = opened.run(ink)
    opened.run("document.getElementById('theme').click()")
    opened.wait(f"return (() => {{ {ink} }})() !== '{light}'")
    before, after = (sum(int(n) for n in re.findall(r"\d+", colours)) for colours in (light, opened.run(ink)))
    assert after > 3 * before
    assert all(drawn_share(opened, plot) > DRAWN for plot in opened.elements(".drawing"))


def test_a_gap_is_no_line(pages, opened):
    opened.open(pages / "report.html")
    trace = "const { x, y } = document.getElementById('time-0').data[0]; "
    assert opened.run(trace + "return x.some((time, k) => y[k] === null && time > 31.9 && time < 32.1)")


def test_it_prints(pages, opened):
    opened.open(pages / "report.html")
    printed = opened.printed()
    assert printed.startswith(b"%PDF") and len(printed) > 50_000
    assert opened.errors() == []
