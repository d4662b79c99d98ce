"""How often what was stated with a probability is right: the table that benchmarks share."""

from collections.abc import Sequence
from itertools import pairwise

from pierburg_ros.proof.intervals import Share


def table(stated: Sequence[tuple[float, bool]], bounds: Sequence[float], heads: tuple[str, str, str]) -> str:
    """One row for each range of probability between the `bounds`; the last range holds 1 itself.

    `stated` has the probability and whether it is right; the `heads` are those of range, number, and number expected.
    """
    rows = [f"| {' | '.join(heads)} | concealed indeed (95 % Wilson interval) |", "|---|---|---|---|"]
    for low, high in pairwise(bounds):
        group = [each for each in stated if low <= each[0] < high or each[0] == high == 1.0]
        if group:
            expected, right = (sum(column) for column in zip(*group, strict=True))
            rows.append(f"| {low:g} to {high:g} | {len(group)} | {expected:.1f} | {Share(right, len(group))} |")
    return "\n".join(rows)
