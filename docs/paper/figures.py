"""Regenerates the paper's figures and README.md beside them: python docs/paper/figures.py."""

from __future__ import annotations

import controller_figures
import loop_figures
import plant_figures
from drawing import FOLDER

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Model


def main() -> None:
    """Draw every figure and write what each shows."""
    model = Model.nominal(read_actuator("pierburg"))
    numbers = {**plant_figures.draw(model), **controller_figures.draw(), **loop_figures.draw(model)}
    template = (FOLDER / "README.template.md").read_text(encoding="utf-8")
    (FOLDER / "README.md").write_text(template.format_map(numbers), encoding="utf-8")


if __name__ == "__main__":
    main()
