"""docs/contract.md, the page that the code cites: what is cited is there, and the catalogue is the published one."""

import re
from pathlib import Path

import pytest

from pierburg_ros.effects import EFFECT

ROOT = Path(__file__).parent.parent
CONTRACT = (ROOT / "docs" / "contract.md").read_text(encoding="utf-8")
SECTIONS = set(re.findall(r"^## (\d+)\.", CONTRACT, flags=re.MULTILINE))
CITING = sorted(
    path
    for folder, kinds in (("pierburg_ros", (".py", ".yaml")), ("test", (".py",)), ("docs", (".md",)))
    for path in (ROOT / folder).rglob("*")
    if path.suffix in kinds and "contract.md" in path.read_text(encoding="utf-8") and path != Path(__file__)
)
ROW = re.compile(r"^\| `(\w+)` \| (.+?) \|", flags=re.MULTILINE)


def published():
    """Parameter names by effect in the table of section 7."""
    table = CONTRACT.split("## 7.")[1].split("## 8.")[0]
    return {effect: re.findall(r"`(\w+)`", parameters) for effect, parameters in ROW.findall(table)}


@pytest.mark.parametrize("path", CITING, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_section_that_is_cited_exists(path):
    cited = re.findall(r"[Ss]ection (\d+)(?= (?:or section \d+ )?of docs/contract\.md)", path.read_text("utf-8"))
    assert set(cited) <= SECTIONS
    if path.suffix == ".py":
        assert cited, "names the contract without a section"


def test_the_package_cites_the_contract_by_its_page():
    for path in sorted((ROOT / "pierburg_ros").rglob("*.py")):
        for line in path.read_text(encoding="utf-8").splitlines():
            assert "contract" not in line or "docs/contract.md" in line, f"{path.name}: {line}"


@pytest.mark.parametrize("effect", published())
def test_a_published_effect_keeps_its_name_and_parameters(effect):
    assert set(published()[effect]) == set(EFFECT[effect].names)
