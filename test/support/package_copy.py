"""The pages on extending the package, and a copy of the package in which they are followed."""

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = "pierburg_ros"


def blocks(page: str, language: str = "python") -> list[str]:
    """The blocks of a page in a language, as they are to be written."""
    text = (ROOT / "docs/extending" / page).read_text(encoding="utf-8")
    return [textwrap.dedent(block) for block in re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)]


def copied(folder: Path) -> Path:
    """A copy of the package in `folder`: the folder of its sources."""
    return shutil.copytree(ROOT / PACKAGE, folder / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))


def insert(path: Path, after: str, new: str) -> None:
    """Put lines behind the one place where `after` stands in a file, each as far to the right as `after` begins."""
    text = path.read_text(encoding="utf-8")
    assert text.count(after) == 1, f"{path} has {text.count(after)} times {after!r}"
    margin = after[: len(after) - len(after.lstrip(" "))]
    path.write_text(text.replace(after, after + textwrap.indent(new, margin)), encoding="utf-8")


def environment(root: Path) -> dict[str, str]:
    """The environment in which a process imports the package under `root`."""
    return {**os.environ, "PYTHONPATH": str(root)}


def printed(root: Path, script: str) -> object:
    """What a script prints as JSON in its last line, run with the package under `root`."""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, env=environment(root), cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])
