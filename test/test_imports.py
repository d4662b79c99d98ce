"""The architecture's rule of who may import whom, read from the sources."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "pierburg_ros"
ALLOWED = {
    "errors": set(),
    "budget": {"errors"},
    "arrays": set(),
    "kernel_cache": set(),
    "kernel": {"kernel_cache"},
    "parameter": {"errors"},
    "processes": {"errors"},
    "workers": {"errors"},
    "version": set(),
    "executors": {"errors", "processes", "version", "workers"},
    "intake": {"errors"},
    "effects": {"errors", "kernel", "intake", "parameter", "arrays"},
    "actuators": {"errors", "kernel", "intake", "parameter", "effects", "arrays"},
    "plant": {"errors", "kernel", "intake", "parameter", "workers", "effects", "actuators", "arrays"},
    "control": {"errors", "kernel", "intake", "parameter"},
    "recording": {"errors", "kernel", "intake", "arrays"},
    "serial_line": {"errors"},
}
ALLOWED["export"] = ALLOWED["plant"] | {"plant"}
ALLOWED["monitoring"] = ALLOWED["plant"] | {"plant"}
ALLOWED["closed_loop"] = ALLOWED["plant"] | {"plant", "control"}
ALLOWED["inference"] = ALLOWED["plant"] | {"plant", "recording", "budget"}
ALLOWED["pages"] = {"arrays", "actuators"}
ALLOWED["comparison"] = ALLOWED["inference"] | {"inference", "pages"}
ALLOWED["identification"] = ALLOWED["comparison"] | {"comparison"}
ALLOWED["audit"] = ALLOWED["inference"] | {"inference"}
ALLOWED["diagnosis"] = ALLOWED["audit"] | {"audit", "pages"}
ALLOWED["proof"] = ALLOWED["diagnosis"] | {
    "diagnosis",
    "comparison",
    "control",
    "closed_loop",
    "processes",
    "executors",
    "version",
}
ALLOWED["nodes"] = ALLOWED["proof"] | {"proof", "identification", "monitoring", "serial_line"}
ALLOWED["viewers"] = {"errors", "arrays", "recording"}
ALLOWED["library"] = ALLOWED["proof"] - {"processes", "executors", "version"} | {"identification", "export", "viewers"}
ALLOWED["fleets"] = ALLOWED["library"] | {"library", "executors", "version"}
ALLOWED["starting"] = set()
ALLOWED["cli"] = ALLOWED["nodes"] | {"nodes", "library", "fleets", "workers", "executors", "viewers", "starting"}
ALLOWED["__main__"] = {"starting"}
ALLOWED["__init__"] = {"errors", "fleets", "library", "recording"}
FORMULATION = {"errors", "kernel"}
ROOMS = {
    "cli": {"console": set(), "options": {"console"}},
    "audit": {"fault": set(), "held": set(), "rows": {"fault", "held"}},
    "diagnosis": {
        "schema": set(),
        "cleaning": set(),
        "motion": set(),
        "quality": {"motion", "schema"},
        "location": {"motion", "schema"},
        "limits": set(),
        "remains": {"schema"},
        "found": {"limits", "remains"},
        "result": {"schema"},
        "simulation": {"schema", "result"},
        "report": {
            "cleaning",
            "found",
            "limits",
            "location",
            "motion",
            "quality",
            "remains",
            "result",
            "schema",
        },
    },
    "fleets": {"recordings": set(), "ageing": {"run"}},
    "identification": {
        "fit": set(),
        "identifiability": {"fit"},
        "paper": {"fit"},
        "turn": set(),
        "reach": {"fit", "turn"},
        "identify": {"fit", "identifiability", "paper", "reach", "turn"},
        "experiment": {"fit", "identify", "paper"},
        "description": {"fit", "identifiability", "identify"},
    },
    "inference": {
        "evidence": set(),
        "explanation": set(),
        "least_squares": set(),
        "data": {"evidence"},
        "motion": {"data"},
        "balance": {"data", "motion"},
        "coordinates": {"explanation"},
        "fit": {"coordinates", "data", "evidence", "explanation", "least_squares"},
        "replay": {"data", "fit"},
        "slopes": set(),
        "covariance": {"evidence"},
        "intervals": {"coordinates", "covariance", "evidence", "explanation", "fit", "slopes"},
        "polish": {"covariance", "fit", "intervals"},
        "shortlist": {"balance", "coordinates", "data", "evidence", "explanation", "fit", "intervals", "least_squares"},
        "changes": {"balance", "coordinates", "explanation", "fit", "least_squares", "shortlist"},
        "search": {
            "balance",
            "changes",
            "coordinates",
            "explanation",
            "fit",
            "intervals",
            "least_squares",
            "shortlist",
        },
        "choice": {"evidence", "explanation", "fit", "polish", "search", "shortlist"},
    },
    "nodes": {
        "core": set(),
        "graph": {"core"},
        "recording": {"core", "graph"},
        "reports": {"core", "graph"},
    },
    "plant": {
        "parameters": set(),
        "model": {"parameters"},
        "torques": set(),
        "state": {"torques"},
        "motion": {"torques"},
        "gear": {"torques", "motion"},
        "signal_path": {"torques", "motion", "gear", "state"},
    },
    "proof": {
        "dirt": set(),
        "formulation": set(),
        "real": {"document", "intervals", "run", "score", "seal", "tally", "trial_run", "visibility"},
    },
    "recording": {
        "units": set(),
        "formats": {"columns", "loss", "units"},
        "signals": {"formats"},
        "signal_map": {"signals", "units"},
        "message_types": {"formats", "signal_map", "signals"},
        "decoding": {"formats", "message_types", "signal_map", "signals"},
        "topics": {"decoding", "formats", "signal_map", "signals"},
        "read": {
            "clocks",
            "columns",
            "file_times",
            "formats",
            "loss",
            "recording",
            "signal_map",
            "signals",
            "tables",
            "topics",
        },
        "inspection": {
            "clocks",
            "columns",
            "decoding",
            "formats",
            "loss",
            "message_types",
            "read",
            "recording",
            "signal_map",
            "signals",
            "tables",
            "units",
        },
    },
}
"""Rooms inside a part, and which others of them each may import. What is not named stands above, and may import all."""
ROS = {
    "builtin_interfaces",
    "diagnostic_msgs",
    "launch",
    "launch_ros",
    "lifecycle_msgs",
    "rcl_interfaces",
    "rclpy",
    "rosgraph_msgs",
    "sensor_msgs",
    "std_msgs",
    "std_srvs",
}
SOURCES = sorted(PACKAGE.rglob("*.py"))


def module_of(source):
    """Full name of the module in a source file."""
    return ".".join(source.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_of(source) for source in SOURCES}


def statements(tree):
    """All nodes of a syntax tree but those that only a type checker reads."""
    for node in ast.iter_child_nodes(tree):
        if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
            yield node
            yield from statements(node)


def imported(source):
    """Full names of the modules that a source file imports anywhere in it."""
    for node in statements(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{source} imports relatively"
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            yield from inner & MODULES
            if inner - MODULES:
                yield node.module


def unit(source):
    """The part of the package that a source file belongs to."""
    return source.relative_to(PACKAGE).parts[0].removesuffix(".py")


def units_imported(source):
    """Other parts of the package that a source file imports."""
    names = (name.split(".") for name in imported(source))
    return {name[1] for name in names if name[0] == "pierburg_ros" and len(name) > 1} - {unit(source)}


def room(source):
    """The room inside its part that a source file belongs to, None for the front door."""
    inner = source.relative_to(PACKAGE).parts[1:]
    return inner[0].removesuffix(".py") if inner and inner[0] != "__init__.py" else None


def rooms_imported(source):
    """Other rooms of its own part that a source file imports; the front door is one of them."""
    own = f"pierburg_ros.{unit(source)}"
    names = (name.split(".") for name in imported(source) if f"{name}.".startswith(f"{own}."))
    return {name[2] if len(name) > 2 else "__init__" for name in names} - {room(source)}


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_point_down_the_architecture(source):
    allowed = FORMULATION if "formulation" in source.parts else ALLOWED[unit(source)]
    assert units_imported(source) <= allowed


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_point_down_inside_each_part(source):
    rooms = ROOMS.get(unit(source), {})
    if room(source) in rooms:
        assert rooms_imported(source) <= rooms[room(source)]


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_ros_is_imported_in_nodes_alone(source):
    roots = {name.split(".")[0] for name in imported(source)}
    assert unit(source) == "nodes" or not roots & ROS


@pytest.mark.parametrize("source", sorted((PACKAGE / "nodes" / "core").rglob("*.py")), ids=lambda path: path.stem)
def test_the_core_of_the_nodes_knows_neither_ros_nor_the_nodes_around_it(source):
    names = set(imported(source))
    assert not {name.split(".")[0] for name in names} & ROS
    nodes = {name for name in names if name.startswith("pierburg_ros.nodes")}
    assert all(name.startswith("pierburg_ros.nodes.core") for name in nodes)


def test_every_part_of_the_package_has_its_place_in_the_rule():
    parts = {unit(source) for source in SOURCES}
    assert parts <= set(ALLOWED)


def test_every_folder_inside_a_part_has_its_place_in_the_rule():
    folders = {(unit(source), room(source)) for source in SOURCES if len(source.relative_to(PACKAGE).parts) > 2}
    assert folders <= {(part, name) for part, rooms in ROOMS.items() for name in rooms}


def test_every_room_of_the_rule_is_there():
    there = {(unit(source), room(source)) for source in SOURCES}
    assert {(part, name) for part, rooms in ROOMS.items() for name in rooms} <= there
    assert set(ALLOWED) <= {part for part, _ in there}


def test_no_circle_between_any_two_files():
    graph = {module_of(source): set(imported(source)) & MODULES for source in SOURCES}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" <- ".join(error.args[1]))


@pytest.mark.parametrize(
    ("code", "names"),
    [
        ("import os.path", {"os.path"}),
        ("from pierburg_ros import errors, kernel", {"pierburg_ros.errors", "pierburg_ros.kernel"}),
        ("from pierburg_ros.plant.torques import friction, load", {"pierburg_ros.plant.torques.friction",
                                                                   "pierburg_ros.plant.torques.load"}),
        ("from pierburg_ros.plant import Model", {"pierburg_ros.plant"}),
        ("def late():\n    from pierburg_ros.plant import decode", {"pierburg_ros.plant.decode"}),
        ("if TYPE_CHECKING:\n    from pierburg_ros import plant\nimport os", {"os"}),
    ],
)  # fmt: skip
def test_imports_are_read_wherever_they_stand(tmp_path, code, names):
    (tmp_path / "source.py").write_text(code)
    assert set(imported(tmp_path / "source.py")) == names
