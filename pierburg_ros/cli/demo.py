"""`pierburg demo`: the whole story on a fresh machine, from a running graph to the physics a model lacks."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.diagnose import diagnosed_with_progress
from pierburg_ros.cli.graph_experiment import play
from pierburg_ros.cli.replay import summary
from pierburg_ros.cli.run import require_ros
from pierburg_ros.library.output import output_folder
from pierburg_ros.nodes.core.depth import KEPT_MESSAGES
from pierburg_ros.processes import own_graph, running

if TYPE_CHECKING:
    from pierburg_ros.library.comparing import Comparison
    from pierburg_ros.library.diagnosing import Diagnosis
    from pierburg_ros.library.model import Model

SETPOINTS = (
    (0.0, 0.0), (1.0, 0.35), (4.0, 0.87), (7.0, 1.22), (10.0, 0.61), (13.0, 1.05), (15.0, 1.12), (17.0, 0.98),
    (19.0, 0.17), (21.0, 0.24), (23.0, 1.4), (26.0, 0.0), (28.0, 0.0),
)  # fmt: skip
"""Time [s] and setpoint [rad]: steps of 4 to 80 degrees both ways."""
CONCEALED = Path(str(resources.files("pierburg_ros.cli") / "demo.yaml"))
"""Model file of the second run's plant: what it has and the diagnosis is not told."""
NOISE = 0.003
"""Standard deviation of the simulated sensor's noise [V]; guess, 1.5 steps of a 12-bit converter."""


def demo(
    output: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("results/demo"),
) -> dict[str, object]:
    """Close a loop over ROS, record it, replay it; conceal an effect, record again, and have it diagnosed.

    The first run is replayed against the true model. In the second run the plant sticks and its spring has drifted; the
    diagnosis sees the recording alone.
    """
    require_ros()
    from pierburg_ros.diagnosis.report.terminal import shown
    from pierburg_ros.library.model import Model

    console = terminal()
    with output_folder(output) as folder:
        recording = recorded_run(folder, "demo.mcap", {}, False, console)
        comparison = replayed(folder, recording, Model.nominal("pierburg"))
        console.print(summary(comparison))
        concealed = recorded_run(folder, "concealed.mcap", {"model": str(CONCEALED)}, True, console)
        diagnosis = diagnosed(folder / "diagnosis", concealed)
        console.print(f"{concealed.name} and nothing else, diagnosed:", shown(diagnosis.document))
    files = "replay.html (the loop), diagnosis/report.html (the concealed effect)"
    console.print(f"Results in {output}: {files}.", soft_wrap=True)
    return {"replay": json.loads(comparison.to_json()), "diagnosis": json.loads(diagnosis.to_json())}


def recorded_run(
    folder: Path, name: str, physics: Mapping[str, object], simulated_time: bool, console: Console
) -> Path:
    """The recording of a closed loop: plant, controller and recorder as processes, setpoints sent from outside.

    `physics` are parameters of the plant's node that differ from their defaults. In simulated time plant and
    controller wait for each other, so that a busy machine loses no tick.
    """
    setpoints, recording = folder / "setpoints.csv", folder / name
    write_setpoints(setpoints)
    environment = own_graph()
    pace = {"simulated_time": True, "lockstep": True} if simulated_time else {}
    nodes: dict[str, dict[str, object]] = {
        "plant": {"depth": KEPT_MESSAGES, "hall_voltage_noise": NOISE, **pace, **physics},
        "controller": {"depth": KEPT_MESSAGES, "use_sim_time": simulated_time},
    }
    if simulated_time:
        nodes["controller"]["hall_timeout"] = 0.0
    with progress() as show:
        show(Step("compiling simulator and controller, once on a machine"))
        compile_kernels()
    console.print(
        f"Plant, controller and recorder run over DDS for {SETPOINTS[-1][0]:.0f} s of"
        f" {'simulated' if simulated_time else 'wall'} time"
        f" (ROS_DOMAIN_ID={environment['ROS_DOMAIN_ID']})."
    )
    with running(nodes, folder / "nodes.log", environment):
        play("setpoint", setpoints, recording, simulated_time, environment)
    return recording


def write_setpoints(path: Path) -> None:
    """Write the setpoints of the demo as a course file."""
    rows = (f"{time},{setpoint}\n" for time, setpoint in SETPOINTS)
    path.write_text("time,setpoint\n" + "".join(rows))


def compile_kernels() -> None:
    """Have the kernels of the nodes in the cache, so that no node has to compile while others wait for it."""
    from pierburg_ros.control import Controller
    from pierburg_ros.library.model import Model
    from pierburg_ros.plant import Plant

    Plant(Model.nominal("pierburg")).advance(0.0, 0.002)
    controller = Controller()
    controller.step(0.0, 0.42, 0.002)
    controller.change(controller.settings)


def diagnosed(folder: Path, recording: Path) -> Diagnosis:
    """Diagnose a recording as a user would, with nothing but its path, and write the files."""
    from pierburg_ros.library.model import Model
    from pierburg_ros.library.reading import read

    diagnosis = diagnosed_with_progress([read(recording)], Model.nominal("pierburg"))
    diagnosis.save(folder)
    return diagnosis


def replayed(folder: Path, recording: Path, model: Model) -> Comparison:
    """Write the files of a replay and give it."""
    from pierburg_ros.library.comparing import compare

    comparison = compare(recording, model)
    comparison.save(folder)
    return comparison
