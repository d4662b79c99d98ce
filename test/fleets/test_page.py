"""The page of a fleet in a real browser: sorted, filtered, opened, with a thousand units."""

import pytest
from support.browser import NEEDS_BROWSER, browser
from support.fleets import fleet

from pierburg_ros.fleets.page import fleet_page

pytestmark = NEEDS_BROWSER
UNITS = 1000


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """A browser that shows a fleet of a thousand units."""
    folder = tmp_path_factory.mktemp("page")
    made = fleet(units=UNITS, recordings=6, limits={"armature_resistance": 5.0})
    (folder / "plotly.min.js").write_text("")
    page = fleet_page(made.recordings, made.ageing, made.attention, made.sentence, made.nominal.actuator)
    (folder / "fleet.html").write_text(page)
    with browser(tmp_path_factory.mktemp("browser"), 1400) as shown:
        shown.open(folder / "fleet.html")
        yield shown


def first(page, column=1):
    """The text of a column in the first row that is shown."""
    row = "[...document.querySelectorAll('#fleet > tbody > tr')].find((each) => !each.hidden)"
    return page.run(f"return {row}.cells[{column}].textContent")


def click(page, text):
    page.run(f"[...document.querySelectorAll('#fleet button')].find((each) => each.textContent === '{text}').click()")


def test_the_most_urgent_unit_stands_first(opened):
    assert first(opened) == "valve-000"
    assert opened.run("return document.getElementById('first').textContent").startswith("Look at valve-000 first")
    assert opened.errors() == []


def test_a_title_sorts_to_and_fro(opened):
    for expected in ("valve-000", f"valve-{UNITS - 1}"):
        click(opened, "unit")
        assert first(opened) == expected
    assert opened.run("return document.querySelectorAll('#fleet th[aria-sort]').length") == 1


def test_the_filter_leaves_what_fits(opened):
    opened.run("const f = document.getElementById('filter'); f.value = 'valve-01'; f.dispatchEvent(new Event('input'))")
    assert opened.run("return document.getElementById('shown').textContent") == "10 units"
    opened.run("const f = document.getElementById('filter'); f.value = ''; f.dispatchEvent(new Event('input'))")
    opened.run("const k = document.getElementById('kind'); k.value = 'a limit'; k.dispatchEvent(new Event('change'))")
    assert first(opened) == "valve-000"
    opened.run("const k = document.getElementById('kind'); k.value = ''; k.dispatchEvent(new Event('change'))")


def test_a_unit_opens_its_courses_and_the_way_to_each_report(opened):
    click(opened, "valve-000")
    opened.wait("return !!document.querySelector('[data-detail] svg.main-svg')")
    links = opened.run(
        "return [...document.querySelectorAll('[data-detail] a')].map((each) => each.getAttribute('href'))"
    )
    assert links == [f"recordings/valve-000-{number}/report.html" for number in range(6)]
    expanded = "return document.querySelector('[data-unit=\"valve-000\"]').getAttribute('aria-expanded')"
    assert opened.run(expanded) == "true"
    click(opened, "valve-000")
    assert opened.run(expanded) == "false"
    assert opened.run("return document.querySelectorAll('[data-detail]').length") == 0
    assert opened.errors() == []


def test_nothing_is_fetched(opened):
    assert opened.run("return performance.getEntriesByType('resource').length") == 0
