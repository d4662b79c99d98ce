"""What `colcon build` installs, started and stopped there; `make colcon` builds it first."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.ros

INSTALLED = os.environ.get("PIERBURG_INSTALL_SPACE", "")
if not INSTALLED:
    pytest.skip("needs a colcon install space, which 'make colcon' builds and names", allow_module_level=True)

PREFIX = Path(INSTALLED) / "pierburg_ros"
EXECUTABLES = PREFIX / "lib" / "pierburg_ros"
NODES = {"plant": "preparing the simulator", "controller": "", "recorder": "recording"}


@pytest.fixture
def environment(domain, tmp_path):
    """The variables that sourcing the install space sets, on a graph of the test's own."""
    command = f"set -e; source {INSTALLED}/local_setup.bash; env -0"
    sourced = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True).stdout
    variables = dict(entry.split("=", 1) for entry in sourced.split("\0") if "=" in entry)
    own = {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    return {**variables, **own, "ROS_LOG_DIR": str(tmp_path)}


@pytest.mark.parametrize("name", [*NODES, "demo", "simulate", "identify", "replay", "diagnose", "prove", "tune"])
def test_every_node_and_command_is_an_executable(name):
    assert os.access(EXECUTABLES / name, os.X_OK)


def test_the_package_is_in_the_ament_index_with_its_files():
    assert (PREFIX / "share" / "ament_index" / "resource_index" / "packages" / "pierburg_ros").exists()
    share = PREFIX / "share" / "pierburg_ros"
    names = {path.relative_to(share).as_posix() for path in share.rglob("*") if path.is_file()}
    assert {"package.xml", "launch/closed_loop.launch.py", "config/plant.yaml", "config/lockstep.yaml"} <= names


@pytest.mark.parametrize("name", NODES)
def test_a_node_starts_and_stops_there(name, environment, tmp_path):
    log = tmp_path / "output"
    with log.open("w") as output:
        process = subprocess.Popen(
            [EXECUTABLES / name], env=environment, cwd=tmp_path, stdout=output, stderr=subprocess.STDOUT
        )
        end = time.monotonic() + 120.0
        while "[" not in log.read_text() and time.monotonic() < end:
            assert process.poll() is None, log.read_text()
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=90.0) == 0, log.read_text()
    assert NODES[name] in log.read_text()


def test_the_code_that_runs_is_the_installed_one(environment):
    interpreter = (EXECUTABLES / "pierburg").read_text().splitlines()[0].removeprefix("#!")
    code = "import pierburg_ros; print(pierburg_ros.__file__)"
    found = subprocess.run(
        [interpreter, "-c", code], env=environment, cwd="/", capture_output=True, text=True, check=True
    )
    assert Path(found.stdout.strip()).is_relative_to(PREFIX)
