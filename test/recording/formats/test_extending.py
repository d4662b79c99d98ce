"""The format that docs/extending.md adds, added to a copy of the package and read there."""

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
READ = """
import sys
from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording
try:
    found = read_recording(sys.argv[1])
    print(found.quantity, found.time.tolist(), found.measured.tolist(), found.command.values.tolist())
except InputError as error:
    print(error)
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package with the format of the guide."""
    package = tmp_path / "copy" / "pierburg_ros"
    shutil.copytree(ROOT / "pierburg_ros", package, ignore=shutil.ignore_patterns("__pycache__"))
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs/extending.md").read_text(), flags=re.DOTALL)
    formats = package / "recording" / "formats"
    (formats / "json_lines.py").write_text(textwrap.dedent(example))
    table = (formats / "__init__.py").read_text()
    table = table.replace("import csv_table,", "import csv_table, json_lines,")
    table = table.replace("    csv_table.FORMAT,\n", "    csv_table.FORMAT,\n    json_lines.FORMAT,\n")
    (formats / "__init__.py").write_text(table)
    return package.parent


def read(root: Path, path: Path) -> str:
    """What the package under `root` makes of a recording."""
    environment = {**os.environ, "PYTHONPATH": str(root)}
    command = [sys.executable, "-c", READ, str(path)]
    return subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True, check=True).stdout.strip()


def test_the_format_of_the_guide_reads_and_refuses(copy, tmp_path):
    path = tmp_path / "run.jsonl"
    path.write_text('{"time": 5.0, "duty": 0.1, "hall_voltage": 0.42}\n{"time": 5.5, "hall_voltage": 0.5}\n')
    assert read(ROOT, path).endswith("Give another file.")
    assert read(copy, path) == "hall_voltage [0.0, 0.5] [0.42, 0.5] [0.1]"
    path.write_text('{"time": 5.0, "duty"\n')
    assert "cannot be read as a recording (JSONDecodeError" in read(copy, path)
    path.write_text('{"time": 0, "duty": 0, "hall_voltage": 1e300}\n{"time": 1, "duty": 0, "hall_voltage": 0}\n')
    assert "expected magnitudes up to 1e+09" in read(copy, path)
