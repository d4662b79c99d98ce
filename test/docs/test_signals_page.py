"""docs/signals.md: its maps read the recordings that it describes, its table and its refusal are those of the code."""

import re
from pathlib import Path

import numpy as np
import pytest
from support.foreign_bags import bench_run, write_foreign

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording
from pierburg_ros.recording.signals import SIGNALS

PAGE = (Path(__file__).parents[2] / "docs" / "signals.md").read_text(encoding="utf-8")
MAPS = re.findall(r"```yaml\n(.*?)```", PAGE, flags=re.DOTALL)
TABLE, STATED = re.findall(r"```csv\n(.*?)```", PAGE, flags=re.DOTALL)


@pytest.fixture
def signals(tmp_path):
    """Writes a map of the page, by its place."""

    def write(place):
        (tmp_path / "signals.yaml").write_text(MAPS[place])
        return tmp_path / "signals.yaml"

    return write


def test_topics_of_foreign_types(tmp_path, signals):
    bag = write_foreign(tmp_path / "bag", bench_run())
    recording = read_recording(bag, signals=signals(0))
    np.testing.assert_allclose(recording.measured, 1.5708 - 0.02 * np.arange(60))
    np.testing.assert_allclose(recording.command.values, 0.3 * np.sin(0.3 * np.arange(60)), atol=1e-7)
    assert recording.supply_voltage.values[0] == 13.0


def test_the_effort_of_a_joint(tmp_path, signals):
    recording = read_recording(write_foreign(tmp_path / "bag", bench_run()), signals=signals(1))
    assert (recording.input, recording.quantity) == ("torque", "position")
    np.testing.assert_allclose(recording.command.values, 100.0 * recording.measured)


def test_columns_with_semicolons_and_decimal_commas(tmp_path, signals):
    (tmp_path / "run.csv").write_text(TABLE)
    recording = read_recording(tmp_path / "run.csv", signals=signals(2))
    np.testing.assert_allclose(recording.time, [0.0, 0.002, 0.004], atol=1e-12)
    np.testing.assert_allclose(recording.command.values, [0.0, 0.355, 0.355])
    np.testing.assert_allclose(recording.measured, np.array([521, 530, 544]) * 3.3 / 4096)
    np.testing.assert_allclose(recording.supply_voltage.values, [13.5, 13.4, 13.4])


def test_units_that_a_file_states(tmp_path):
    (tmp_path / "run.csv").write_text(STATED)
    recording = read_recording(tmp_path / "run.csv")
    np.testing.assert_allclose(recording.time, [0.0, 0.002], atol=1e-12)
    np.testing.assert_allclose(recording.command.values, [0.0, 0.355])
    np.testing.assert_allclose(recording.measured, np.deg2rad([0.0, 0.1]))


def test_files_in_parts(tmp_path, signals):
    folder = tmp_path / "bench"
    folder.mkdir()
    for part in range(2):
        (folder / f"run_{part}.csv").write_text(f"t,pwm,hall\n{2 * part},0,1.0\n{2 * part + 1},50,2.0\n")
    (folder / "battery.csv").write_text("t,vbat\n0,13.5\n3,13.0\n")
    recording = read_recording(folder, signals=signals(3))
    np.testing.assert_array_equal(recording.time, np.arange(4))
    np.testing.assert_array_equal(recording.supply_voltage.time, [0.0, 3.0])


def test_every_map_of_the_page_is_read_here():
    assert len(MAPS) == 4


def test_the_table_names_every_signal_with_its_units():
    rows = re.findall(r"^\| (`.+?`) \| (.+?) \|", PAGE.split("## Topics")[0], flags=re.MULTILINE)
    said = {name: row[1] for row in rows for name in re.findall(r"`(\w+)`", row[0])}
    assert set(said) == set(SIGNALS)
    assert all(unit in said[name] for name, signal in SIGNALS.items() for unit in signal.units if name != "enabled")


def test_the_refusals_of_the_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("signals.yaml").write_text("duty: {topic: /a, unit: deg}\n")
    Path("bench.csv").write_text("time,duty,position [V]\n0,0,0\n1,0,0\n")
    said = []
    for name, signals in (("run.csv", "signals.yaml"), ("bench.csv", None)):
        with pytest.raises(InputError) as refused:
            read_recording(name, signals=signals)
        said.append(str(refused.value))
    assert "```text\n" + "\n".join(said) + "\n```" in PAGE
