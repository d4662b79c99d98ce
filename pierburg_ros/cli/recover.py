"""`pierburg recover`: a cut recording made whole."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal


def recover(
    recording: Annotated[Path, typer.Argument(help="MCAP file without its end, or rosbag2 folder without metadata.")],
    output: Annotated[
        Path | None, typer.Option(help="The whole copy; by default beside the original, named .recovered.")
    ] = None,
) -> dict[str, object]:
    """Make a cut recording whole for every reader; the original stays as it is.

    Every message that is there in full is kept, with its times, types, and quality of service.
    """
    from pierburg_ros.recording.formats.recover import is_whole
    from pierburg_ros.recording.formats.recover import recover as recovered_copy

    console = terminal()
    if is_whole(recording):
        console.print(f"{recording} is whole; nothing was written.", soft_wrap=True)
        return {"file": str(recording), "whole": True}
    stem = recording.stem.removesuffix(".cut")
    found = recovered_copy(recording, output or recording.with_name(f"{stem}.recovered{recording.suffix}"))
    left_out = f", {found.damaged} damaged records left out" if found.damaged else ""
    console.print(f"{found.path}: {found.messages} messages{left_out}", soft_wrap=True)
    return {"file": str(found.path), "whole": False, "messages": found.messages, "damaged": found.damaged}
