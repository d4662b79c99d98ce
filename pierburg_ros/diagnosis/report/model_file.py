"""The model file of a diagnosis, which says what it is where the model is not to be trusted."""

from __future__ import annotations

from pierburg_ros.diagnosis.result import Result
from pierburg_ros.errors import one_line


def model_text(result: Result) -> str:
    """The model file; its first line is a comment where nothing was concluded or an error is left."""
    return f"{said}{result.model.text()}" if (said := _caveat(result)) else result.model.text()


def _caveat(result: Result) -> str:
    """The comment, or nothing."""
    diagnosis = result.diagnosis
    of = ", ".join(diagnosis.recordings)
    if diagnosis.input_faults:
        return f"# {one_line(f'Not corrected: the diagnosis of {of} concludes nothing, its signals are at fault.')}\n"
    if diagnosis.verdict == "unexplained":
        return f"# {one_line(f'Not confirmed: the diagnosis of {of} leaves an error that it does not explain.')}\n"
    return ""
