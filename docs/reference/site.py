"""What the site adds to the pages as GitHub shows them: its contents, and blocks of code in docstrings."""

from __future__ import annotations

import re
from typing import Any

PAGE = re.compile(r"\[([^\]]+)\]\(([^)]+)\.md\)")


def with_contents(index: str) -> str:
    """The index with a hidden table of contents after each list of pages, which GitHub shows as the list alone."""
    sections = index.split("\n## ")
    return "\n## ".join([sections[0], *(f"{section}\n{_contents(section)}\n" for section in sections[1:])])


def _contents(section: str) -> str:
    pages = "\n".join(f"{title[0].upper()}{title[1:]} <{page}>" for title, page in PAGE.findall(section))
    return f"```{{toctree}}\n:hidden:\n:caption: {section.splitlines()[0]}\n\n{pages}\n```"


def code_blocks(*event: Any) -> None:
    """Make what a docstring sets in a block of code: it stands indented behind an empty line."""
    lines = event[-1]
    starts = [k for k in range(1, len(lines)) if lines[k].startswith("    ") and not lines[k - 1].strip()]
    for k in reversed([k for k in starts if not lines[k - 2].startswith("    ")]):
        lines[k:k] = [".. code-block:: python", ""]


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""

    def read(_: Any, page: str, source: list[str]) -> None:
        if page == "index":
            source[0] = with_contents(source[0])

    app.connect("source-read", read)
    app.connect("autodoc-process-docstring", code_blocks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
