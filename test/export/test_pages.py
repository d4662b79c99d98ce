"""The page on one's own simulator and the example that it uses, run as they stand."""

import csv
import runpy
import shutil
from pathlib import Path

import numpy as np
import pytest
from support.recordings import NOMINAL

from pierburg_ros.export import export
from pierburg_ros.plant import Inputs, simulate
from pierburg_ros.plant.decode import decoded

pytest.importorskip("mujoco", minversion="3.13")
ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "run_in_mujoco.py"


def test_the_example_writes_what_mujoco_makes_of_a_duty(tmp_path):
    time = np.arange(0.0, 4.0, 0.004)
    duty = np.where(time < 0.5, 0.0, 0.25)
    (tmp_path / "valve.xml").write_text(export(NOMINAL, "mujoco").text)
    rows = "".join(f"{t},{d}\n" for t, d in zip(time, duty, strict=True))
    (tmp_path / "duty.csv").write_text("time,duty\n" + rows)
    main = runpy.run_path(str(EXAMPLE))["main"]
    main(*(str(tmp_path / name) for name in ("valve.xml", "duty.csv", "mine.csv")))
    with (tmp_path / "mine.csv").open() as file:
        written = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert [row["duty"] for row in written] == list(duty)
    ours = decoded(NOMINAL, simulate(NOMINAL, Inputs(time, duty), time))
    assert np.allclose([row["position"] for row in written], ours, atol=5e-4)


@pytest.mark.search
def test_the_page_on_ones_own_simulator_runs_from_top_to_bottom(tmp_path, monkeypatch):
    for file in (EXAMPLE, ROOT / "examples" / "bench.csv"):
        shutil.copy(file, tmp_path)
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "simulator.md").read_text(encoding="utf-8")
    names: dict[str, object] = {}
    for code in page.split("```python\n")[1:]:
        exec(code.split("```")[0], names)
    diagnosis = names["diagnosis"]
    assert diagnosis.effects == ("static_friction",)
    assert diagnosis.document.simulation.rmse < 0.001
    assert diagnosis.model.values["armature_resistance"] == pytest.approx(4.55, rel=0.05)
