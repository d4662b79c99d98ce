"""What the audit finds: a signal that is not what it is read as, how that shows, and what mends it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One signal that is not what it is read as.

    `mend` is the line of the signal map that mends it (section 3 of docs/contract.md), or what to do where none does.
    """

    recording: str
    signal: str
    what: str
    evidence: str
    mend: str

    def __str__(self) -> str:
        return f"{self.recording}: {self.signal}: {self.what}. {self.evidence} Mend: {self.mend}"
