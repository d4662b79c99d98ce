"""What the pages on extending the package say, done as they say it."""

import re
import textwrap
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

ROOT = Path(__file__).parent.parent


def blocks(page: str, language: str) -> list[str]:
    """The blocks of a page in a language, as they are to be written."""
    text = (ROOT / "docs/extending" / page).read_text(encoding="utf-8")
    return [textwrap.dedent(block) for block in re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)]


def test_the_actuator_of_the_page_stands_where_its_numbers_say(tmp_path: Path) -> None:
    (tmp_path / "flap.yaml").write_text(blocks("actuator.md", "yaml")[0])
    model = Model.nominal(read_actuator(tmp_path / "flap.yaml"))
    angle = simulate(model, Inputs(np.array([0.0]), np.array([0.05])), np.arange(5000) / 500.0)[-1]
    assert angle == pytest.approx(30.0 * 0.02 * 12.0 * 0.05 / 2.0 / 0.5, rel=1e-4)
