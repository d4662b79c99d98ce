"""Seals a trial's truth before the diagnosis starts and checks on opening that nothing was changed since.

The seal is the SHA-256 of the truth file and of the unseen recording. The truth carries a random nonce, so
that it cannot be found by sealing guesses.
"""

from __future__ import annotations

import hashlib
import json
import secrets
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError

SEALED = ("truth.json", "holdout.mcap")
SEAL = "seal.json"


def digest(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def seal(folder: Path, truth: dict[str, Any]) -> None:
    """Write `truth` into `folder` and seal it with the unseen recording that lies there."""
    (folder / "truth.json").write_text(json.dumps({**truth, "nonce": secrets.token_hex(16)}, indent=1))
    (folder / SEAL).write_text(json.dumps({name: digest(folder / name) for name in SEALED}, indent=1))


def opened(folder: Path) -> dict[str, Any]:
    """The truth in `folder`; InputError where it or the unseen recording is not what was sealed."""
    recorded = json.loads((folder / SEAL).read_text())
    for name in SEALED:
        if digest(folder / name) != recorded.get(name):
            raise InputError(f"{folder.name}/{name} is not what was sealed before the diagnosis. Remove {folder.name}.")
    truth: dict[str, Any] = json.loads((folder / "truth.json").read_text())
    return truth
