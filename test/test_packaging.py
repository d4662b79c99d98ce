"""What pip, colcon and ROS read of the package, against what the package is."""

import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from zipfile import ZipFile

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.version import Version
from support.launch_file import given_to, launched

from pierburg_ros.control import SETTINGS, Settings
from pierburg_ros.control.parameter_file import NODE_PARAMETERS, read_parameter_file
from pierburg_ros.nodes.core.controller_parameters import CONTROLLER, PROTECTION, WINDING
from pierburg_ros.nodes.core.monitor_parameters import MONITOR
from pierburg_ros.nodes.core.plant_parameters import PLANT
from pierburg_ros.nodes.core.recorder_parameters import RECORDER
from pierburg_ros.nodes.core.serial_driver_parameters import SERIAL_DRIVER

ROOT = Path(__file__).parent.parent
LAUNCH = ROOT / "launch" / "closed_loop.launch.py"
MONITOR_ALONE = ROOT / "launch" / "monitor.launch.py"
MONITORED = ROOT / "launch" / "monitored_valve.launch.py"
TWO = ROOT / "launch" / "two_valves.launch.py"
REPLAY = ROOT / "launch" / "replay.launch.py"
LINTERS = ROOT / "test" / "test_ament.py"
MANIFEST = ElementTree.parse(ROOT / "package.xml").getroot()
SETUP = (ROOT / "setup.py").read_text()
NOT_OF_ROS = re.compile(r"python3-")


def dependencies():
    """Names of all packages that package.xml depends on."""
    return {element.text for element in MANIFEST if element.tag.endswith("depend")}


def test_the_manifest_is_format_3_and_invents_neither_a_maintainer_nor_an_address():
    assert MANIFEST.attrib["format"] == "3"
    assert MANIFEST.find("maintainer").attrib["email"].endswith(".invalid")
    assert MANIFEST.find("url") is None and "maintainer" not in SETUP and "url=" not in SETUP
    assert MANIFEST.findtext("license") == "Apache-2.0"
    assert MANIFEST.findtext("export/build_type") == "ament_python"


def test_manifest_and_setup_agree():
    assert MANIFEST.findtext("name") == "pierburg_ros"
    assert not re.search(r"version=['\"]", SETUP), "the version is read from package.xml"


def test_every_ros_package_that_the_nodes_import_is_a_dependency():
    from test_imports import ROS, SOURCES, imported

    used = {name.split(".")[0] for source in SOURCES for name in imported(source)} & ROS
    used |= {name.split(".")[0] for launch in ROOT.glob("launch/*.py") for name in imported(launch)} & ROS
    used |= {node["package"] for node in launched(MONITORED)[1]} - {"pierburg_ros"}
    used |= set(re.findall(r'importorskip\("(ament_\w+)', LINTERS.read_text()))
    assert used == {name for name in dependencies() if not NOT_OF_ROS.match(name)}


def test_the_wheels_are_an_extra_and_not_a_requirement():
    assert '"ros": ROS_WHEELS' in SETUP
    required = SETUP.split("install_requires=")[1].split("]")[0]
    assert "ros-" not in required


def pinned(file):
    """Every version that a file of constraints names, by the requirement's name."""
    found = {}
    for line in (ROOT / "constraints" / file).read_text().splitlines():
        if not line.startswith("#"):
            requirement = Requirement(line)
            found.setdefault(requirement.name, []).append(requirement)
    return found


def test_the_oldest_versions_tested_are_those_that_are_allowed():
    """No version without bounds but that of setuptools, which colcon and ROS choose."""
    lowest = {name: str(each.specifier).removeprefix("==") for name, (each,) in pinned("lowest.txt").items()}
    allowed = {
        each.name: str(each.specifier).removeprefix(">=") for each in requirements() if each.name != "setuptools"
    }
    assert set(lowest) == set(allowed)
    assert {name: Version(number) for name, number in lowest.items()} == {
        name: Version(number) for name, number in allowed.items()
    }


@pytest.mark.parametrize("python", ["3.10", "3.11", "3.12", "3.13"])
def test_the_newest_versions_tested_are_allowed_and_one_for_each_python(python):
    newest = pinned("newest.txt")
    for required in requirements():
        if required.name != "setuptools":
            held = [
                each
                for each in newest[required.name]
                if each.marker is None or each.marker.evaluate({"python_version": python})
            ]
            assert len(held) == 1
            assert required.specifier.contains(str(held[0].specifier).removeprefix("=="))


def requirements():
    """What setup.py requires to run."""
    return [Requirement(line) for line in declared("install_requires", "sdist")]


def test_files_that_are_installed_exist():
    assert (ROOT / "resource" / "pierburg_ros").exists()
    assert {path.name for path in (ROOT / "config").glob("*.yaml")} >= {
        "plant.yaml",
        "controller.yaml",
        "recorder.yaml",
    }


def test_the_launch_file_names_executables_and_parameter_files_that_exist():
    _, nodes = launched()
    assert [node["executable"] for node in nodes] == ["plant", "controller", "recorder"]
    for node in nodes:
        assert node["executable"] in entry_points("install")
        (file,), _ = given_to(node)
        assert Path(file).exists()


def test_every_launch_argument_has_a_description():
    arguments, _ = launched()
    of_nodes = {"actuator", "model", "setpoint", "output"}
    assert set(arguments) == {"namespace", "time", "record", "log_level", "config", "on_exit", *of_nodes}
    assert all(len(each["description"]) > 20 for each in arguments.values())


@pytest.mark.parametrize("time", ["wall", "simulated", "lockstep"])
def test_one_launch_argument_sets_the_time_of_all_nodes(time):
    _, nodes = launched(time=time)
    plant, controller, recorder = (given_to(node)[1] for node in nodes)
    assert controller["use_sim_time"] == recorder["use_sim_time"] == plant["simulated_time"] == (time != "wall")
    assert plant["lockstep"] == (time == "lockstep")


def test_the_launch_file_gives_only_parameters_that_exist():
    _, nodes = launched(time="lockstep", namespace="left", record="true")
    declared = (PLANT, CONTROLLER, RECORDER)
    for node, declarations in zip(nodes, declared, strict=True):
        accepted = {each.name: each for each in declarations}
        for name, value in given_to(node)[1].items():
            assert name == "use_sim_time" or accepted[name].accepted(value) == value
        assert node["namespace"] == "left"


def test_a_text_that_looks_like_a_number_stays_a_text_and_a_number_a_number():
    _, nodes = launched(output="1e5", setpoint="1")
    _, controller, recorder = (given_to(node)[1] for node in nodes)
    assert recorder["output"] == "1e5" and '"1e5"' in nodes[2]["ros_arguments"][-1]
    assert isinstance(controller["setpoint"], float)
    with pytest.raises(ValueError, match="setpoint is 'wide'; expected a number"):
        launched(setpoint="wide")


def test_switches_have_choices_so_that_no_other_word_passes_for_false():
    arguments, _ = launched()
    assert arguments["record"]["choices"] == ["true", "false"]
    arguments, _ = launched(MONITORED)
    assert {arguments[name]["choices"][0] for name in ("driver", "monitor", "picture")} == {"true"}


@pytest.mark.parametrize("wanted", ["shutdown", "respawn", "ignore"])
def test_an_argument_says_what_follows_when_plant_or_controller_ends(wanted):
    _, (plant, controller, recorder) = launched(on_exit=wanted)
    for node in (plant, controller):
        assert ("on_exit" in node, node.get("respawn", False)) == (wanted == "shutdown", wanted == "respawn")
    assert "on_exit" not in recorder and "respawn" not in recorder


def test_the_picture_has_the_joint_and_the_frames_of_its_namespace():
    _, nodes = launched(MONITORED, namespace="left", driver="false")
    assert [node["executable"] for node in nodes] == ["monitor", "robot_state_publisher"]
    _, given = given_to(nodes[1])
    assert given["frame_prefix"] == "left_"
    joint = ElementTree.fromstring(given["robot_description"]).find("joint")
    assert joint.get("name") == "left_swirl_shaft"


def test_two_valves_are_the_loops_and_the_monitored_valves_of_two_namespaces():
    _, included = launched(TWO, output="runs")
    assert [(file.name, said["namespace"]) for file, said in included] == [
        (name, side) for side in ("left", "right") for name in ("closed_loop.launch.py", "monitored_valve.launch.py")
    ]
    for file, said in included:
        assert file.exists() and said.keys() <= launched(file)[0].keys()


def test_the_launch_file_leaves_the_recorder_out_when_told():
    _, nodes = launched(record="false")
    assert [node["name"] for node in nodes] == ["plant", "controller"]


def test_the_monitor_is_launched_with_parameters_that_it_has():
    arguments, (node,) = launched(MONITOR_ALONE, namespace="left", angle="hall_voltage", simulated_time="true")
    assert all(len(each["description"]) > 20 for each in arguments.values())
    assert node["executable"] in entry_points("install") and node["namespace"] == "left"
    accepted = {each.name: each for each in MONITOR}
    _, given = given_to(node)
    assert given.pop("use_sim_time") is True
    assert given["angle_topic"] == "hall_voltage"
    for name, value in given.items():
        assert accepted[name].accepted(value) == value
    for name in ("angle", "duty"):
        assert set(arguments[name]["choices"]) == set(accepted[f"{name}_topic"].choices)


def test_a_replay_is_launched_as_the_command_that_a_person_would_type(tmp_path):
    arguments, (process,) = launched(REPLAY, recording="run.mcap", output=str(tmp_path / "out"))
    assert all(len(each["description"]) > 20 for each in arguments.values())
    executable, *command = process["cmd"]
    assert executable == "pierburg_ros/replay" and "replay" in entry_points("install")
    assert command == ["run.mcap", "--actuator", "pierburg", "--output", str(tmp_path / "out")]
    _, (process,) = launched(REPLAY, recording="run.mcap", model="model.yaml", signals="map.yaml")
    assert process["cmd"][2:6] == ["--model", "model.yaml", "--signals", "map.yaml"]


def test_a_replay_opens_its_result_where_there_is_one():
    _, (process, handler) = launched(REPLAY, recording="run.mcap", viewer="plotjuggler")
    assert handler.target_action is process
    (viewer,) = handler.on_exit(SimpleNamespace(returncode=0), None)
    assert handler.on_exit(SimpleNamespace(returncode=2), None) == []
    assert viewer["cmd"][:3] == ["plotjuggler/plotjuggler", "--datafile", "replayed/replay.mcap"]
    assert Path(viewer["cmd"][4]).exists()


def entry_points(*arguments):
    """Executables that setup.py declares when it is called with these arguments."""
    return dict(line.split(" = ") for line in declared("entry_points['console_scripts']", *arguments))


def declared(what, *arguments):
    """The items that setup.py gives for `what` when it is called with these arguments."""
    code = (
        "import sys; from distutils.core import run_setup; "
        f"print(*run_setup('setup.py', sys.argv[1:], stop_after='init').{what}, sep=chr(10))"
    )
    command = [sys.executable, "-c", f"import setuptools; {code}", *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()


@pytest.mark.parametrize("arguments", [["install", "--record", "files"], ["develop", "--editable"]])
def test_colcon_gets_an_executable_for_every_node_and_command(arguments):
    pytest.importorskip("rclpy")
    from pierburg_ros.cli.app import COMMANDS
    from pierburg_ros.cli.run import NODES

    found = entry_points(*arguments)
    assert set(found) == {"pierburg", *NODES, *COMMANDS} - {"run"}
    for target in found.values():
        module, function = target.split(":")
        assert callable(getattr(import_module(module), function))


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel that pip makes of the source distribution, in an empty folder."""
    folder = tmp_path_factory.mktemp("distribution")
    source = folder / "source"
    left_out = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "build", "docs", "install", "log", "test")
    shutil.copytree(ROOT, source, ignore=left_out)
    make = "import sys; from setuptools import build_meta; build_meta.build_sdist(sys.argv[1])"
    subprocess.run([sys.executable, "-c", make, folder], cwd=source, check=True, capture_output=True)
    (distribution,) = folder.glob("*.tar.gz")
    pip = [sys.executable, "-m", "pip", "--quiet", "wheel", "--no-deps", "--no-index", "--no-build-isolation"]
    subprocess.run([*pip, "-w", folder / "wheels", distribution], check=True)
    (made,) = (folder / "wheels").iterdir()
    return made


def test_the_wheel_of_the_source_distribution_holds_every_file_of_the_package(wheel):
    with ZipFile(wheel) as archive:
        held = {name for name in archive.namelist() if ".dist-info/" not in name}
    package = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "pierburg_ros").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    share = f"{wheel.name.removesuffix('-py3-none-any.whl')}.data/data/share/pierburg_ros"
    shared = {
        f"{share}/{path.relative_to(ROOT).as_posix()}"
        for pattern in ("launch/*.launch.py", "config/*.yaml", "layouts/*.*[ln]", "urdf/*.urdf", "sros2/*.xml")
        for path in ROOT.glob(pattern)
    }
    index = f"{share.removesuffix('/pierburg_ros')}/ament_index/resource_index/packages/pierburg_ros"
    assert held == package | shared | {index, f"{share}/package.xml"}


def test_the_version_of_the_wheel_is_that_of_the_manifest(wheel):
    with ZipFile(wheel) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        assert f"\nVersion: {MANIFEST.findtext('version')}\n" in archive.read(metadata).decode()


def test_pip_puts_the_one_command_on_the_path(wheel, tmp_path):
    apart = ["--no-compile", "--ignore-installed", "--prefix", tmp_path]  # leaves the environment of the tests alone
    pip = [sys.executable, "-m", "pip", "--quiet", "install", "--no-deps", "--no-index"]
    subprocess.run([*pip, *apart, wheel], check=True)
    assert [path.name for path in (tmp_path / "bin").iterdir()] == ["pierburg"]


def parameters(file):
    """Parameters that a configuration file gives to a node of any name."""
    return yaml.safe_load((ROOT / "config" / file).read_text())["/**"]["ros__parameters"]


def test_the_launch_file_of_a_real_valve_starts_executables_with_parameters_that_they_have():
    _, nodes = launched(MONITORED, model="m.yaml")
    assert [node["executable"] for node in nodes] == ["serial_driver", "monitor", "robot_state_publisher"]
    assert {node["executable"] for node in nodes[:2]} <= set(entry_points("install"))
    for node, declarations in zip(nodes, (SERIAL_DRIVER, MONITOR), strict=False):
        accepted = {each.name: each for each in declarations}
        for name, value in given_to(node)[1].items():
            assert accepted[name].accepted(value) == value


def test_policies_and_urdf_are_installed():
    assert 'glob("urdf/*.urdf")' in SETUP
    assert 'glob("sros2/*.policy.xml")' in SETUP


def test_the_plants_file_names_parameters_that_exist_in_their_range():
    from pierburg_ros.nodes.core.physics import Physics, chosen_model

    physics = Physics(chosen_model("pierburg", ""), "exact", 0.0, 0)
    declared = {each.name: each for each in (*PLANT, *physics.declarations())}
    given = parameters("plant.yaml")
    assert {name: declared[name].accepted(value) for name, value in given.items()} == given
    nominal = {each.name: each.default for each in physics.declarations()}
    assert {name: value for name, value in given.items() if name in nominal}.items() <= nominal.items()


def test_the_controllers_file_holds_the_settings_in_the_package():
    assert read_parameter_file(ROOT / "config" / "controller.yaml") == Settings()
    assert {each.name for each in (*CONTROLLER, *PROTECTION, *WINDING)} <= NODE_PARAMETERS
    assert {setting.name for setting in SETTINGS} <= set(parameters("controller.yaml"))


def test_the_recorders_file_names_parameters_that_exist():
    declared = {each.name: each for each in RECORDER}
    given = parameters("recorder.yaml")
    assert {name: declared[name].accepted(value) for name, value in given.items()} == given


@pytest.mark.parametrize("file", sorted((ROOT / "config").glob("*.yaml")), ids=lambda path: path.name)
def test_every_number_in_a_configuration_has_its_unit_or_origin_beside_it(file):
    for line in file.read_text().splitlines():
        if re.search(r":\s*-?[\d.]+", line.split("#")[0]):
            assert "#" in line, line
