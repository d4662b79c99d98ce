"""One word for one thing: constants of the package, words of the pages, and how many of them there are."""

import re
from collections import defaultdict
from pathlib import Path

import pytest
from support.documentation import ROOT
from support.named_numbers import NamedNumber, numbers_of

DOCS = ROOT / "docs"
ABANDONED = re.compile(
    r"\b(told|heard|vouch\w*|witness\w*|stood|wander\w*|remainders?)\b|\b(an?|the|its|no|each|every|this) tells?\b",
    flags=re.IGNORECASE,
)
"""Words of this project alone, and "tell" as a noun; docs/glossary.md has those of the field."""
PAGES = ["README.md", *sorted(str(path.relative_to(ROOT)) for path in DOCS.rglob("*.md"))]


def collisions() -> dict[str, list[NamedNumber]]:
    """Named numbers whose name has another value, or another meaning, elsewhere in the package."""
    named = defaultdict(list)
    for found in numbers_of():
        named[found.name].append(found)
    return {name: each for name, each in named.items() if ambiguous(each)}


def ambiguous(found: list[NamedNumber]) -> bool:
    """Whether numbers of one name differ in value, or in what their docstrings say; no docstring says nothing else."""
    return len({each.value for each in found}) > 1 or len({each.decides for each in found if each.decides}) > 1


def listed(collided: dict[str, list[NamedNumber]]) -> str:
    """Names with their files, a line each."""
    return "\n".join(f"{name}: {', '.join(each.file for each in found)}" for name, found in sorted(collided.items()))


def test_a_constant_has_one_meaning():
    assert not listed(collisions())


def test_two_meanings_of_a_name_are_seen():
    assert ambiguous([NamedNumber("A", value, f"{value}.py", "Time.", "", "") for value in ("1", "2")])
    assert ambiguous([NamedNumber("A", "1", f"{says}.py", says, "", "") for says in ("Time.", "Length.")])
    assert not ambiguous([NamedNumber("A", "1", f"{says}.py", says, "", "") for says in ("Time.", "")])


@pytest.mark.parametrize("page", PAGES)
def test_a_page_uses_the_words_of_the_field(page):
    lines = (ROOT / page).read_text(encoding="utf-8").splitlines()
    assert not [f"{page}:{k}: {line}" for k, line in enumerate(lines, 1) if ABANDONED.search(line)]


def test_the_glossary_is_short_and_says_each_term_once():
    page = (DOCS / "glossary.md").read_text(encoding="utf-8")
    _, *terms = re.findall(r"^\| ([^|]+?) \| [^|]+ \|$", page, flags=re.MULTILINE)
    assert 30 <= len(terms) <= 60
    assert terms == sorted(set(terms), key=str.lower)


def words(paths: list[Path]) -> int:
    """How many words pages have, counted as `wc -w` does."""
    return sum(len(path.read_text(encoding="utf-8").split()) for path in paths)


def test_the_site_and_the_pages_for_developers_are_short():
    pages = [path for path in DOCS.rglob("*.md") if path.name != "README.template.md"]
    developers = [path for path in pages if path.is_relative_to(DOCS / "developers")]
    site = [path for path in pages if path not in developers and not path.is_relative_to(DOCS / "reference")]
    assert words(site) <= 25_000
    assert words(developers) <= 10_000
