"""What the pages on extending the package say, done as they say it."""

from pathlib import Path

import numpy as np
import pytest
from support.package_copy import blocks, copied, insert, printed

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

LIES_ON_STOPS = """
import json
import numpy as np
from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.at_stops import share_at_stops
from pierburg_ros.inference.data import data_of
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording
nominal = Model.nominal(read_actuator("pierburg"))
time = np.arange(1000) / 100.0
angle = np.interp(time, [0.0, 4.0, 5.0, 7.0, 8.0, 10.0], np.array([0.0, 0.0, 1.0, 1.0, 0.5, 0.5]) * np.pi / 2)
noise = 0.003 * np.random.default_rng(1).standard_normal(time.size)
duty = Channel(np.array([0.0, 4.0, 7.0]), np.array([0.0, 0.3, 0.15]))
recording = Recording("drawn", "hall_voltage", time, 0.42 + 4.1 * angle / (np.pi / 2) + noise, duty)
print(json.dumps(share_at_stops(data_of([recording], nominal))))
"""
DIAGNOSED = """
import json
import numpy as np
from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording
nominal = Model.nominal(read_actuator("pierburg"))
time = np.arange(600) / 100.0
inputs = Inputs(np.array([0.0, 3.0]), np.array([0.0, 0.2]))
measured = simulate(nominal, inputs, time) + 0.003 * np.random.default_rng(1).standard_normal(time.size)
found = diagnose([Recording("made", "hall_voltage", time, measured, Channel(inputs.time, inputs.command))], nominal)
text = found.diagnosis.text()
Diagnosis.model_validate_json(text)
print(json.dumps(json.loads(text)))
"""


def test_the_actuator_of_the_page_stands_where_its_numbers_say(tmp_path: Path) -> None:
    (tmp_path / "flap.yaml").write_text(blocks("actuator.md", "yaml")[0])
    model = Model.nominal(read_actuator(tmp_path / "flap.yaml"))
    angle = simulate(model, Inputs(np.array([0.0]), np.array([0.05])), np.arange(5000) / 500.0)[-1]
    assert angle == pytest.approx(30.0 * 0.02 * 12.0 * 0.05 / 2.0 / 0.5, rel=1e-4)


@pytest.fixture(scope="module")
def with_step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package with the step of docs/extending/diagnosis.md."""
    root = tmp_path_factory.mktemp("step")
    diagnosis = copied(root) / "diagnosis"
    (file, field), (call,) = blocks("diagnosis.md"), blocks("diagnosis.md", "text")
    (diagnosis / "at_stops.py").write_text(file)
    regimes = '    regimes: list[Regime] = []\n    """Of the first recording."""\n'
    insert(diagnosis / "schema.py", regimes, field)
    findings = diagnosis / "report/findings.py"
    insert(findings, "        regimes=ranges,\n", call)
    others = "from pierburg_ros.diagnosis import quality, remains\n"
    insert(findings, others, "from pierburg_ros.diagnosis.at_stops import share_at_stops\n")
    return root


def test_the_step_of_the_page_finds_the_shaft_on_its_stops(with_step: Path) -> None:
    """Of 10 s drawn, 4 s at the closed stop and 2 s at the open one, and a little of the way there and back."""
    assert printed(with_step, LIES_ON_STOPS) == pytest.approx({"closed": 0.4, "open": 0.2}, abs=0.02)


@pytest.mark.search
def test_the_step_of_the_page_is_in_the_document(with_step: Path) -> None:
    """The nominal valve lies on the closed stop for 3 of 6 s, and 20 % of duty does not open it all the way."""
    document = printed(with_step, DIAGNOSED)
    assert document["share_at_stops"] == pytest.approx({"closed": 0.5, "open": 0.0}, abs=0.03)
