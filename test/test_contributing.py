"""The effect that docs/extending/effect.md adds, added to a copy of the package and used there.

The copy shares the cache of compiled kernels with the untouched package, which must not lend it an old result.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.search

ROOT = Path(__file__).parent.parent
PACKAGE = "pierburg_ros"
PRELOAD, STIFFNESS, BRAKING = 0.29, 0.1419, (37.3 * 0.022) ** 2 / 4.139  # Table I
START, DUTY, TIME_CONSTANT = 0.8, 0.16, 0.03
SIMULATED = """
import json, sys
import numpy as np
from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
model = Model.nominal(read_actuator("pierburg")).with_values({"coulomb_friction": 0.0, **json.loads(sys.argv[1])})
inputs = Inputs(np.array([0.0]), np.array([float(sys.argv[2])]))
print(json.dumps(simulate(model, inputs, np.arange(150) / 500.0, float(sys.argv[3])).tolist()))
"""
SETTABLE = """
import json
from pierburg_ros.nodes.core.physics import Physics
from pierburg_ros.plant import read_model
model = read_model({"actuator": "pierburg", "effects": {"output_filter": {"time_constant": 0.01}}})
declared = {each.name: each.default for each in Physics(model, "exact", 0.0, 0).declarations()}
print(json.dumps([model.active_effects, model.as_mapping()["effects"], declared["output_filter.time_constant"]]))
"""
LOOKED_FOR = """
import json
from concurrent.futures import ThreadPoolExecutor
import numpy as np
from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop.open_loop import simulate_measurement
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fitter, ladder
from pierburg_ros.inference.motion import motion_of
from pierburg_ros.inference.shortlist import Span, forms, promises
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording.recording import Channel, Recording
random = np.random.default_rng(1)
actuator = read_actuator("pierburg")
nominal = Model.nominal(actuator)
inputs = Inputs(np.arange(60) * 0.2, np.concatenate([[0.0], random.uniform(-0.1, 0.4, 59)]))
time = np.arange(6000) / 500.0
measured = simulate_measurement(nominal.with_values({"output_filter.time_constant": 0.02}), inputs, time, 0.003)
channel = Channel(inputs.time, inputs.command)
data = data_of([Recording("run", "hall_voltage", time, measured, channel)], nominal)
fitter = Fitter(data, nominal, ladder(data)[0])
balance = Balance(actuator, tuple(motion_of(run, nominal, fitter.constant) for run in data.runs))
candidates = [each for each in forms(data, nominal, Span(100.0, 0.0, 1.0)) if each[0].effect == "output_filter"]
base = fitter.fit(Explanation(), nominal.values, 0)
with ThreadPoolExecutor(1) as pool:
    best = promises(base, balance, candidates, pool)[0]
found = fitter.fit(Explanation((), (best.variant,)), best.values)
print(json.dumps([found.values["output_filter.time_constant"], base.ratio, found.ratio]))
"""


def add_example(root: Path) -> None:
    """Follow docs/extending/effect.md in the package under `root`."""
    file, line = re.findall(r"```python\n(.*?)```", (ROOT / "docs/extending/effect.md").read_text(), flags=re.DOTALL)
    effects, path = root / PACKAGE / "effects", root / PACKAGE / "plant/signal_path.py"
    (effects / "output_filter.py").write_text(textwrap.dedent(file))
    replace(
        effects / "__init__.py", "    load_dependent_friction,\n", "    load_dependent_friction,\n    output_filter,\n"
    )
    replace(
        effects / "__init__.py", "    input_delay.EFFECT,\n", "    input_delay.EFFECT,\n    output_filter.EFFECT,\n"
    )
    import_of_kernels = "from pierburg_ros.kernel import kernel\n"
    replace(path, import_of_kernels, f"from pierburg_ros.effects import output_filter\n{import_of_kernels}")
    after = "        in_force = command\n"
    replace(path, after, f"{after}        {line.strip()}\n")


def replace(path: Path, old: str, new: str) -> None:
    """Put `new` for the one `old` in a file."""
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


def copied(folder: Path) -> Path:
    """A copy of the package in `folder`."""
    shutil.copytree(ROOT / PACKAGE, folder / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache of compiled kernels that all copies share."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(scope="module")
def extended(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package with the example added."""
    root = copied(tmp_path_factory.mktemp("extended"))
    add_example(root)
    return root


def run(root: Path, cache: Path, script: str, *arguments: object) -> object:
    """What a script prints as JSON that runs with the package under `root`."""
    environment = {**os.environ, "PYTHONPATH": str(root), "XDG_CACHE_HOME": str(cache)}
    command = [sys.executable, "-c", script, *map(str, arguments)]
    done = subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def test_the_example_is_absent_at_strength_zero_bit_for_bit(extended: Path, tmp_path: Path, cache: Path) -> None:
    without = run(copied(tmp_path), cache, SIMULATED, "{}", DUTY, START)
    absent = run(extended, cache, SIMULATED, '{"output_filter.time_constant": 0.0}', DUTY, START)
    assert absent == without


def test_the_example_acts_as_its_equation_says(extended: Path, cache: Path) -> None:
    """Without friction and inertia: BRAKING w + STIFFNESS angle = torque (1 - exp(-t / TIME_CONSTANT)) - PRELOAD."""
    values = json.dumps({"output_filter.time_constant": TIME_CONSTANT})
    voltage = np.array(run(extended, cache, SIMULATED, values, DUTY, START))
    time = np.arange(voltage.size) / 500.0
    torque = 37.3 * 0.022 * 13.5 * DUTY / 4.139
    share = -torque / (STIFFNESS - BRAKING / TIME_CONSTANT)
    final = (torque - PRELOAD) / STIFFNESS
    angle = final + share * np.exp(-time / TIME_CONSTANT)
    angle += (START - final - share) * np.exp(-time * STIFFNESS / BRAKING)
    assert np.ptp(angle) > 0.01
    assert voltage == pytest.approx(0.42 + 4.1 * angle / (np.pi / 2), abs=2e-4)


def test_the_example_is_in_model_files_and_among_the_parameters_of_the_node(extended: Path, cache: Path) -> None:
    assert run(extended, cache, SETTABLE) == [["output_filter"], {"output_filter": {"time_constant": 0.01}}, 0.01]


def test_the_diagnosis_looks_for_the_example_and_finds_its_value(extended: Path, cache: Path) -> None:
    found, without, beside = run(extended, cache, LOOKED_FOR)
    assert without > 2.0
    assert beside == pytest.approx(1.0, abs=0.05)
    assert found == pytest.approx(0.02, rel=0.05)
