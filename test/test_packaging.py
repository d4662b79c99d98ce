"""What pip, colcon and ROS read of the package, against what the package is."""

import ast
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml

from pierburg_ros.control import SETTINGS, Settings
from pierburg_ros.control.parameter_file import read_parameter_file
from pierburg_ros.nodes.core.monitor_parameters import MONITOR
from pierburg_ros.nodes.core.plant_parameters import PLANT
from pierburg_ros.nodes.core.recorder_parameters import RECORDER
from pierburg_ros.nodes.core.serial_driver_parameters import SERIAL_DRIVER

ROOT = Path(__file__).parent.parent
LAUNCH = ROOT / "launch" / "closed_loop.launch.py"
MONITORED = ROOT / "launch" / "monitored_valve.launch.py"
MANIFEST = ElementTree.parse(ROOT / "package.xml").getroot()
SETUP = (ROOT / "setup.py").read_text()
NOT_OF_ROS = re.compile(r"python3-")


def dependencies():
    """Names of all packages that package.xml depends on."""
    return {element.text for element in MANIFEST if element.tag.endswith("depend")}


def literals(path):
    """All text constants in a source file."""
    return {n.value for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.Constant)}


def test_the_manifest_is_format_3_with_a_valid_maintainer():
    assert MANIFEST.attrib["format"] == "3"
    address = MANIFEST.find("maintainer").attrib["email"]
    assert re.fullmatch(r"[\w.+-]+@[\w-]+(\.[\w-]+)+", address)
    assert MANIFEST.findtext("license") == "Apache-2.0"
    assert MANIFEST.findtext("export/build_type") == "ament_python"


def test_manifest_and_setup_agree():
    assert MANIFEST.findtext("name") == "pierburg_ros"
    assert f'version="{MANIFEST.findtext("version")}"' in SETUP


def test_every_ros_package_that_the_nodes_import_is_a_dependency():
    from test_imports import ROS, SOURCES, imported

    used = {name.split(".")[0] for source in SOURCES for name in imported(source)} & ROS
    used |= {name.split(".")[0] for launch in (LAUNCH, MONITORED) for name in imported(launch)} & ROS
    used |= set(re.findall(r'package="(\w+)"', MONITORED.read_text())) - {"pierburg_ros"}
    assert used == {name for name in dependencies() if not NOT_OF_ROS.match(name)}


def test_the_wheels_are_an_extra_and_not_a_requirement():
    assert 'extras_require={"ros": ROS_WHEELS' in SETUP
    required = SETUP.split("install_requires=")[1].split("]")[0]
    assert "ros-" not in required


def test_files_that_are_installed_exist():
    assert (ROOT / "resource" / "pierburg_ros").exists()
    assert {path.name for path in (ROOT / "config").glob("*.yaml")} >= {
        "plant.yaml",
        "controller.yaml",
        "recorder.yaml",
    }


def test_the_launch_file_names_executables_and_parameter_files_that_exist():
    text = LAUNCH.read_text()
    executables = re.findall(r'executable="(\w+)"', text)
    assert sorted(executables) == ["controller", "plant", "recorder"]
    assert all(f'"{name} = pierburg_ros.nodes.{name}:main"' in SETUP for name in executables)
    files = [name for name in literals(LAUNCH) if isinstance(name, str) and name.endswith(".yaml")]
    assert sorted(files) == ["controller.yaml", "plant.yaml", "recorder.yaml"]
    assert all((ROOT / "config" / name).exists() for name in files)


def test_the_launch_file_of_a_real_valve_starts_executables_with_parameters_that_they_have():
    text = MONITORED.read_text()
    ours = re.findall(r'package="pierburg_ros",\s+executable="(\w+)"', text)
    assert sorted(ours) == ["monitor", "serial_driver"]
    assert all(f'"{name} = pierburg_ros.nodes.{name}:main"' in SETUP for name in ours)
    given = [re.findall(r'"(\w+)"', names) for names in re.findall(r"for name in \((.+?)\)", text)]
    assert set(given[0]) <= {each.name for each in SERIAL_DRIVER}
    assert set(given[1]) <= {each.name for each in MONITOR}


def test_policies_and_urdf_are_installed():
    assert 'glob("urdf/*.urdf")' in SETUP
    assert 'glob("sros2/*.policy.xml")' in SETUP


def parameters(file, node):
    """Parameters that a configuration file gives to a node."""
    return yaml.safe_load((ROOT / "config" / file).read_text())[node]["ros__parameters"]


def test_the_plants_file_names_parameters_that_exist_in_their_range():
    from pierburg_ros.nodes.core.physics import Physics, chosen_model

    physics = Physics(chosen_model("pierburg", ""), "exact", 0.0, 0)
    declared = {each.name: each for each in (*PLANT, *physics.declarations())}
    given = parameters("plant.yaml", "plant")
    assert {name: declared[name].accepted(value) for name, value in given.items()} == given
    nominal = {each.name: each.default for each in physics.declarations()}
    assert {name: value for name, value in given.items() if name in nominal}.items() <= nominal.items()


def test_the_controllers_file_holds_the_settings_in_the_package():
    assert read_parameter_file(ROOT / "config" / "controller.yaml") == Settings()
    assert {setting.name for setting in SETTINGS} <= set(parameters("controller.yaml", "controller"))


def test_the_recorders_file_names_parameters_that_exist():
    declared = {each.name: each for each in RECORDER}
    given = parameters("recorder.yaml", "recorder")
    assert {name: declared[name].accepted(value) for name, value in given.items()} == given


@pytest.mark.parametrize("file", sorted((ROOT / "config").glob("*.yaml")), ids=lambda path: path.name)
def test_every_number_in_a_configuration_has_its_unit_or_origin_beside_it(file):
    for line in file.read_text().splitlines():
        if re.search(r":\s*-?[\d.]+", line.split("#")[0]):
            assert "#" in line, line
