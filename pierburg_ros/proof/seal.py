"""Seals a trial's truth before the diagnosis starts and checks on opening that nothing was changed since.

The seal is the SHA-256 of the truth file and of what belongs to it, such as the unseen recording. The truth carries a
random nonce, so that it cannot be found by sealing guesses.
"""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError

TRUTH, UNSEEN = "truth.json", "holdout.mcap"
SEAL = "seal.json"


def digest(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def seal(folder: Path, truth: dict[str, Any], beside: Sequence[str] = (UNSEEN,)) -> None:
    """Write `truth` into `folder` and seal it with the files `beside` it that lie there."""
    (folder / TRUTH).write_text(json.dumps({**truth, "nonce": secrets.token_hex(16)}, indent=1))
    (folder / SEAL).write_text(json.dumps({name: digest(folder / name) for name in (TRUTH, *beside)}, indent=1))


def opened(folder: Path) -> dict[str, Any]:
    """The truth in `folder`; InputError where it or a file beside it is not what was sealed."""
    for name, sealed in json.loads((folder / SEAL).read_text()).items():
        if digest(folder / name) != sealed:
            raise InputError(f"{folder.name}/{name} is not what was sealed before the diagnosis. Remove {folder.name}.")
    truth: dict[str, Any] = json.loads((folder / TRUTH).read_text())
    return truth
