"""The blocks of code on the pages of the documentation, and the commands in them."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from pierburg_ros.cli import app

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(
    r"^(?P<margin> *)```(?P<language>\S*)\n(?P<text>.*?)^(?P=margin)```$", flags=re.MULTILINE | re.DOTALL
)


@dataclass(frozen=True)
class Block:
    """A block between fences: its page (a path from the root), its language, its text."""

    page: str
    language: str
    text: str


def pages() -> list[str]:
    """The paths of all pages, from the root."""
    own = [path for path in (ROOT / "docs").rglob("*.md") if path.name != "README.template.md"]
    return ["README.md", "CONTRIBUTING.md", *sorted(str(path.relative_to(ROOT)) for path in own)]


def blocks(page: str, *languages: str) -> list[Block]:
    """The blocks of a page in some languages, or all."""
    found = BLOCK.finditer((ROOT / page).read_text(encoding="utf-8"))
    every = (Block(page, each["language"], textwrap.dedent(each["text"])) for each in found)
    return [block for block in every if not languages or block.language in languages]


def commands(block: Block) -> Iterator[list[str]]:
    """The commands of a block of shell, as words; comments are left out."""
    for line in block.text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words:
            yield words


def run_shown(words: list[str]) -> None:
    """Run a command of ours, an example or a command of the shell in the present folder."""
    if words[0] == "pierburg":
        with pytest.raises(SystemExit) as ending:
            app.main(words[1:])
        assert ending.value.code == 0, words
    elif words[0] == "python":
        subprocess.run([sys.executable, *words[1:]], check=True)
    else:
        subprocess.run(words, check=True)


SAID = "=== a text of the page stands here ==="
"""A line between what the blocks before a quoted text have said and what comes after it."""


def clone(folder: Path) -> Path:
    """What git tracks of the project, copied to `folder`, set up as `make` does it: with this environment as .venv."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in tracked.strip("\0").split("\0"):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    (folder / ".venv").mkdir()
    (folder / ".venv" / "bin").symlink_to(Path(sys.prefix) / "bin")
    for stamp in (".ready", ".installed"):
        (folder / ".venv" / stamp).touch()
    return folder


def pasted(page: str, folder: Path) -> list[tuple[str, str]]:
    """Paste every block of a page into one shell in `folder`, from top to bottom; the first command that fails ends it.

    Python is pasted into `python`. Gives each text that the page quotes, with what was printed since the one before.
    """
    shown = {"sh": "{}", "python": "python <<'PYTHON'\n{}PYTHON\n", "text": f"echo '{SAID}'\n"}
    found = blocks(page, *shown)
    script = "".join(shown[block.language].replace("{}", block.text) for block in found)
    kept = {name: value for name, value in os.environ.items() if name not in ("VIRTUAL_ENV", "PYTHONPATH")}
    path = os.pathsep.join(each for each in kept["PATH"].split(os.pathsep) if not each.startswith(sys.prefix))
    done = subprocess.run(
        ["bash", "-ec", script],
        cwd=folder,
        env={**kept, "PATH": path, "COLUMNS": "100"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, f"{page}:\n{done.stdout}\n{done.stderr}"
    quoted = [block.text for block in found if block.language == "text"]
    return list(zip(quoted, done.stdout.split(SAID), strict=False))
