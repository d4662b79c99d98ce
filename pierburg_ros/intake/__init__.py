"""The gate that every input passes: kind of file, size, depth, counts, magnitudes; what is refused is one line."""

from pierburg_ros.intake.bounds import check_count, check_magnitude
from pierburg_ros.intake.gate import opened, path_of, reading, text_of
from pierburg_ros.intake.table import lines, rows
from pierburg_ros.intake.yaml_file import Document, parsed, read_yaml

__all__ = [
    "Document",
    "check_count",
    "check_magnitude",
    "lines",
    "opened",
    "parsed",
    "path_of",
    "read_yaml",
    "reading",
    "rows",
    "text_of",
]
