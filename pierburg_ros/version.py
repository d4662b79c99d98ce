"""Which version of the sources a result belongs to."""

from __future__ import annotations

import hashlib
from pathlib import Path

PACKAGE = Path(__file__).parent
DIAGNOSING = ("actuators", "audit", "diagnosis", "effects", "estimation", "plant", "recording")
"""Folders whose sources a diagnosis depends on."""


def source_version(package: Path = PACKAGE) -> str:
    """Digest of the sources that a diagnosis depends on."""
    digest = hashlib.sha256()
    for part in DIAGNOSING:
        for file in sorted((package / part).rglob("*.py")):
            digest.update(file.relative_to(package).as_posix().encode() + file.read_bytes())
    return digest.hexdigest()[:16]
