"""The effect that CONTRIBUTING.md adds, added to a copy of the package and run there.

The copy shares the cache of compiled kernels with the untouched package, which must not lend it an old result.
"""

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

ROOT = Path(__file__).parent.parent
PACKAGE = "pierburg_ros"
DUTY, COEFFICIENT = 0.15, 0.05
RUN = """
import numpy as np, sys
from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

pytestmark = pytest.mark.search
model = Model.nominal(read_actuator("pierburg")).with_values({"coulomb_friction": 0.0})
if sys.argv[1] != "0":
    model = model.with_values({"air_flow.coefficient": float(sys.argv[1])})
print(repr(simulate(model, Inputs(np.array([0.0]), np.array([DUTY])), np.arange(15000) / 500.0)[-1]))
""".replace("DUTY", str(DUTY))


def add_example(root: Path) -> None:
    """Follow CONTRIBUTING.md in the package under `root`."""
    file, line = re.findall(r"```python\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text(), flags=re.DOTALL)
    effects, load = root / PACKAGE / "effects", root / PACKAGE / "plant" / "torques" / "load.py"
    (effects / "air_flow.py").write_text(textwrap.dedent(file))
    registry = (effects / "__init__.py").read_text()
    registry = registry.replace("    armature_inductance,\n", "    air_flow,\n    armature_inductance,\n", 1)
    registry = registry.replace("    external_load.EFFECT,", "    air_flow.EFFECT,\n    external_load.EFFECT,", 1)
    (effects / "__init__.py").write_text(registry)
    source = load.read_text().replace("import cogging_torque,", "import air_flow, cogging_torque,")
    before = "    if p.external_load.torque != 0.0"
    load.write_text(source.replace(before, f"    {line.strip()}\n{before}"))


def final_voltage(root: Path, coefficient: float, cache: Path) -> float:
    """Where the frictionless valve comes to rest, by the package under `root`."""
    environment = {**os.environ, "PYTHONPATH": str(root), "XDG_CACHE_HOME": str(cache)}
    command = [sys.executable, "-c", RUN, str(coefficient)]
    done = subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True, check=True)
    return float(re.search(r"[-\d.]+", done.stdout.replace("np.float64", "")).group())


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the package."""
    shutil.copytree(ROOT / PACKAGE, tmp_path / "copy" / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path / "copy"


def test_the_example_of_the_guide_acts_and_leaves_the_rest_alone(copy: Path, tmp_path: Path) -> None:
    without = final_voltage(copy, 0, tmp_path / "cache")
    add_example(copy)

    def surplus(angle: float, coefficient: float) -> float:
        motor = 37.3 * 0.022 * 13.5 * DUTY / 4.139  # Table I, at rest
        return motor - 0.29 - 0.1419 * angle - coefficient * np.sin(2.0 * angle)

    for coefficient in (0.0, COEFFICIENT):
        angle = brentq(surplus, 0.0, np.pi / 2, args=(coefficient,))
        voltage = final_voltage(copy, coefficient, tmp_path / "cache")
        assert voltage == pytest.approx(0.42 + 4.1 * angle / (np.pi / 2), abs=1e-5)
        if coefficient == 0.0:
            assert voltage == without
