"""What is known of an effect stands in its own file: nothing else in the package but the signal path names it."""

import re
from pathlib import Path

import pytest

from pierburg_ros.effects import EFFECTS

PACKAGE = Path(__file__).parent.parent / "pierburg_ros"
SIGNAL_PATH = ("plant/torques/", "plant/motion/", "plant/gear/", "plant/signal_path.py", "plant/state.py")
OTHERS = ("effects/__init__.py", "proof/")
"""The list of effects, and the proof, which has its own list to be independent of it."""
SOURCES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))
NAMED = re.compile(rf"\b({'|'.join(effect.id for effect in EFFECTS)})\b")


@pytest.mark.parametrize("source", [path for path in SOURCES if not path.startswith((*SIGNAL_PATH, *OTHERS))])
def test_no_effect_is_named_outside_its_file_and_the_signal_path(source: str) -> None:
    own = Path(source).stem if source.startswith("effects/") else ""
    named = set(NAMED.findall((PACKAGE / source).read_text(encoding="utf-8")))
    assert named <= {own}


def test_the_rule_sees_a_name_where_there_is_one() -> None:
    assert {path for path in SOURCES if NAMED.search((PACKAGE / path).read_text(encoding="utf-8"))} >= {
        f"effects/{effect.id}.py" for effect in EFFECTS
    }
