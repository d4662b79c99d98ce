"""Completion in shells that run: installed as docs/terminal.md says, asked for with the Tab key."""

import shutil
from pathlib import Path

import pytest

pytest.importorskip("pty")

from support.live_shell import LiveShell

ROOT = Path(__file__).parents[2]
TABS = {"bash": "\t", "zsh": "\t\t", "fish": "\t"}
"""In zsh the first Tab of a session only loads the completion."""

SHOW_LINE = "\x01echo = \n"
"""Keys: to the beginning of the line, a word that shows the line in place of running it, Enter."""
WANTED = {"pierburg rec": "pierburg recover", "pierburg identify --fi": "pierburg identify --fix"}


@pytest.mark.search
@pytest.mark.parametrize("shell", TABS)
def test_the_tab_key_completes_commands_and_options(shell, tmp_path):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    with LiveShell(shell, tmp_path, ROOT) as live:
        live.type("pierburg --install-completion\n")
        live.until("completion installed")
    with LiveShell(shell, tmp_path, ROOT) as live:
        for line, completed in WANTED.items():
            live.type(f"{line}{TABS[shell]}{SHOW_LINE}")
            live.until(f"= {completed}")
