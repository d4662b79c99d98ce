"""Names that come from files reach pages and pictures as text: no markup, no formula."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.comparison.page import replay_page
from pierburg_ros.comparison.plot import picture
from pierburg_ros.identification.page import identification_page
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

NAME = "</script><script>alert(1)</script><img src=x onerror=alert(2)>$\\frac$"
TIME = np.arange(500) * 0.01


@pytest.fixture
def comparison():
    actuator = replace(read_actuator("pierburg"), name=NAME)
    measured = np.sin(TIME)
    recording = Recording(NAME, "hall_voltage", TIME, measured, Channel(TIME, 0.1 * measured))
    return Comparison(recording, Model.nominal(actuator), measured + 0.01)


def assert_harmless(written: str) -> None:
    """No tag of the name, neither as markup nor as what plotly makes markup of."""
    own = written[written.index("</head>") :] + written[: written.index("<style>")]
    assert "alert(1)" in own
    for tag in ("<script>alert", "<img", r"\u003cscript", r"\u003cimg"):
        assert tag not in own


def test_the_page_of_a_replay(comparison):
    assert_harmless(replay_page(comparison, {"measured": NAME}, [("recording", NAME)]))


def test_the_page_of_an_identification(comparison):
    fitted = SimpleNamespace(
        residuals=[comparison.residual], names=("a",), correlation=np.ones((1, 1)), rmse=0.1, model=comparison.model
    )
    parameters = {"a": {"value": 1.0, "unit": "V", "ci95": [0.9, 1.1], "identifiable": True, "fixed": False}}
    content = {"parameters": parameters, "lumps": None, "static_characteristic": None}
    model = SimpleNamespace(actuator=comparison.model.actuator, values={"a": 1.0})
    found = SimpleNamespace(
        fitted=fitted, static=None, model=model, noise=0.1, validation_rmse=0.1, as_mapping=lambda: content
    )
    assert_harmless(identification_page(found, [comparison.recording]))


def test_the_picture_of_a_replay_takes_a_formula_for_a_name(tmp_path, comparison):
    picture(comparison).savefig(tmp_path / "replay.png")
    assert (tmp_path / "replay.png").stat().st_size > 10_000
