"""A table in a file, and what reading it says where it is refused."""

from pathlib import Path

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording


def table(folder: Path, text: str, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def refusal(path: Path, **options: object) -> str:
    with pytest.raises(InputError) as refused:
        read_recording(path, **options)
    assert "\n" not in str(refused.value)
    return str(refused.value)
