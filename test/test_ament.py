"""The linters of ROS, where they are installed; `make lint` has the same rules for every other machine."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
CHECKED = [str(ROOT / name) for name in ("pierburg_ros", "test", "launch", "benchmarks", "examples", "sros2")]


def test_ament_flake8():
    ament = pytest.importorskip("ament_flake8.main")
    status, errors = ament.main_with_errors(["--config", str(ROOT / "test" / "ament_flake8.ini"), *CHECKED])
    assert status == 0, "\n".join(errors)


def test_ament_pep257():
    ament = pytest.importorskip("ament_pep257.main")
    unwritten = [f"D10{number}" for number in range(8)]
    options = ["--convention", "google", "--add-ignore", *unwritten, "--"]
    assert ament.main([*options, *CHECKED]) == 0
