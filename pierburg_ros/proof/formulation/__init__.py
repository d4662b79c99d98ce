"""The valve a second time: textbook equations on a fixed fine step, apart from `effects/` and `plant/`.

Agreement between this folder and the exact simulator is evidence, not construction: nothing here imports
`effects`, `plant` or `diagnosis`, and the solution method shares no idea with theirs.
"""

from pierburg_ros.proof.formulation.textbook import TextbookPlant, simulate_textbook
from pierburg_ros.proof.formulation.values import NOMINAL, OUTSIDE, active_outside, textbook_values

__all__ = ["NOMINAL", "OUTSIDE", "TextbookPlant", "active_outside", "simulate_textbook", "textbook_values"]
