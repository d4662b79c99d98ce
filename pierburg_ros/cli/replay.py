"""`pierburg replay`: simulate a recorded duty and compare with what was measured."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.options.recordings import (
    ResultsOption,
    SignalsOption,
    TimeOption,
    TopicOption,
    faults_first,
    losses_first,
    results_folder,
    topics_of,
)
from pierburg_ros.cli.options.viewers import RerunOption
from pierburg_ros.library.output import output_folder
from pierburg_ros.library.result import Result
from pierburg_ros.pages.listing import Listing


def replay(
    recording: Annotated[Path, typer.Argument(help="MCAP, rosbag2 directory or CSV.")],
    output: ResultsOption = None,
    model: ModelOption = None,
    actuator: ActuatorOption = None,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
    rerun: RerunOption = None,
) -> str:
    """Simulate a recorded duty and compare with what was measured.

    Writes replay.json, replay.csv, replay.mcap, replay.html, replay.png and model.yaml to the output folder.
    """
    from pierburg_ros.library.comparing import compare
    from pierburg_ros.library.reading import read

    chosen, output = chosen_model(model, actuator), results_folder(output, "replay", recording)
    measured = read(recording, time=time, topics=topics_of(topic), signals=signals, actuator=chosen.actuator)
    with output_folder(output) as folder:
        comparison = compare(measured, chosen)
        comparison.write_into(folder)
    if rerun:
        comparison.write_rerun(rerun)
    console = terminal()
    losses_first(console, [measured])
    faults_first(console, [measured], chosen)
    console.print(summary(comparison))
    console.print(f"Results in {output}: replay.html, .png, .json, .csv, .mcap, model.yaml", soft_wrap=True)
    return comparison.to_json()


def summary(result: Result) -> Listing:
    """The main numbers of a result as a table for the terminal."""
    return Listing(("", ""), [*result.rows().items()], result.title)
