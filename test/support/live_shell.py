"""An interactive shell on a terminal of its own, typed into as a person would."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import select
import signal
import sys
import time
from pathlib import Path

PATIENCE = 240.0
"""Time [s] after which an answer counts as missing: a machine under load takes tens of seconds to start Python."""
CONTROL = re.compile(
    r"\x1b(\[[0-9;?=<>]*[ -/]*[@-~]|\][^\x07\x1b]*(\x07|\x1b\\)|[()][A-Z0-9]|[=>78cM])|[\r\x08\x0f\x0e]"
)
"""What moves the cursor and sets colours and titles."""
INTERACTIVE = {"bash": ["bash", "-i"], "zsh": ["zsh", "-i"], "fish": ["fish", "-i"]}
RECORDED = {"bash": ".bashrc", "zsh": ".zshrc", "fish": ".config/fish/config.fish"}
"""The file that a shell reads when it starts, below the home folder."""
QUIET = {
    "bash": "PS1='> '; bind 'set enable-bracketed-paste off'\n",
    "zsh": "PS1='> '; unsetopt zle_bracketed_paste prompt_sp;\n",
    "fish": "set -g fish_greeting; function fish_prompt; echo -n '> '; end\n",
}
"""A plain prompt."""


class LiveShell:
    """`bash`, `zsh` or `fish` with an empty home folder, where `pierburg` runs the package at `root`."""

    def __init__(self, shell: str, home: Path, root: Path) -> None:
        self.seen = ""
        environment = prepared(shell, home, root)
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.chdir(home)
            os.execvpe(shell, INTERACTIVE[shell], environment)

    def __enter__(self) -> LiveShell:
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)
        os.close(self.terminal)

    def type(self, keys: str) -> None:
        """Press keys; what was shown before is forgotten."""
        self.seen = ""
        os.write(self.terminal, keys.encode())

    def until(self, text: str) -> None:
        """Wait until `text` is shown since the last keys."""
        deadline = time.monotonic() + PATIENCE
        while text not in CONTROL.sub("", self.seen):
            assert time.monotonic() < deadline, f"no {text!r} in {self.seen!r}"
            if select.select([self.terminal], [], [], 1.0)[0]:
                self.seen += os.read(self.terminal, 65536).decode(errors="replace")


def prepared(shell: str, home: Path, root: Path) -> dict[str, str]:
    """The environment of a shell that reads nothing of the user's, and finds `pierburg`."""
    file = home / RECORDED[shell]
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(QUIET[shell])
    command = home / "bin" / "pierburg"
    command.parent.mkdir(exist_ok=True)
    command.write_text(f'#!/bin/sh\nPYTHONPATH={root} exec {sys.executable} -m pierburg_ros "$@"\n')
    command.chmod(0o755)
    (home / ".local/share/fish/generated_completions").mkdir(parents=True, exist_ok=True)  # else it reads all manuals
    kept = {name: os.environ[name] for name in ("LANG", "LC_ALL", "TMPDIR") if name in os.environ}
    path = f"{command.parent}:{os.environ['PATH']}"
    return {**kept, "HOME": str(home), "PATH": path, "TERM": "xterm", "SHELL": shell, "COLUMNS": "100", "LINES": "40"}
