"""Results of recordings on disk: what has one is not diagnosed again.

recordings/<key>/result.json      what the tables say of it, or why it could not be used
recordings/<key>/report.html      the report, beside diagnosis.json and model.yaml
recordings/<key>/measured-<...>   what the fleet's model makes of it
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError

RECORDINGS = "recordings"
RESULT = "result.json"


class Store:
    """The results in the folder `output`, which is made if need be."""

    def __init__(self, output: Path) -> None:
        if output.exists() and not output.is_dir():
            raise InputError(f"{output} is a file, expected a folder for the fleet. Choose another folder.")
        self.folder = output / RECORDINGS
        self.folder.mkdir(parents=True, exist_ok=True)

    def known(self) -> frozenset[str]:
        """The keys that have a result."""
        return frozenset(each.parent.name for each in self.folder.glob(f"[!.]*/{RESULT}"))

    def result(self, key: str) -> dict[str, Any]:
        """What is known of the recording with this key."""
        found: dict[str, Any] = json.loads((self.folder / key / RESULT).read_text(encoding="utf-8"))
        return found

    def keep(self, key: str, result: Mapping[str, Any], files: Mapping[str, str]) -> None:
        """Keep a result and its files: all of them, or nothing."""
        with tempfile.TemporaryDirectory(dir=self.folder, prefix=".") as hidden:
            partial = Path(hidden) / key
            partial.mkdir()
            for name, text in {**files, RESULT: json.dumps(result, allow_nan=False)}.items():
                (partial / name).write_text(text, encoding="utf-8")
            if not (self.folder / key).exists():
                partial.rename(self.folder / key)

    def measured(self, key: str, names: Sequence[str]) -> dict[str, Any] | None:
        """What was measured of these quantities; None where that is still to be done."""
        file = self._measured(key, names)
        return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None

    def keep_measured(self, key: str, names: Sequence[str], found: Mapping[str, Any]) -> None:
        """Keep what was measured."""
        file = self._measured(key, names)
        partial = file.with_name(f".{file.name}")
        partial.write_text(json.dumps(found, allow_nan=False), encoding="utf-8")
        os.replace(partial, file)

    def _measured(self, key: str, names: Sequence[str]) -> Path:
        return self.folder / key / f"measured-{hashlib.sha256(' '.join(names).encode()).hexdigest()[:12]}.json"
