"""What the benchmarks ran on, and where in docs/developers/measurements.md their tables go."""

from __future__ import annotations

import os
import platform
from pathlib import Path

MEASUREMENTS = Path(__file__).parent.parent / "docs/developers/measurements.md"


def machine() -> str:
    """Processor, memory, system and Python in one line."""
    processors = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":", 1)[1].strip() for line in processors if line.startswith("model name")), "unknown")
    pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return (
        f"{os.cpu_count()} cores of {model}, {pages / 2**30:.0f} GiB, {platform.system()} {platform.release()}, "
        f"Python {platform.python_version()}"
    )


def write_section(name: str, text: str) -> None:
    """Put `text` between the marks of section `name` on the page of measurements, at its end where there are none."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    document = MEASUREMENTS.read_text(encoding="utf-8")
    section = f"{begin}\n{text.strip()}\n{end}"
    if begin in document:
        before, rest = document.split(begin)
        document = before + section + rest.split(end, 1)[1]
    else:
        document = f"{document.rstrip()}\n\n{section}\n"
    MEASUREMENTS.write_text(document, encoding="utf-8")
