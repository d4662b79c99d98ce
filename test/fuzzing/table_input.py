"""CSV inputs: recordings, setpoints and duties."""

import random

from fuzzing.mutations import mutated_text
from fuzzing.values import CELLS


def table(chance: random.Random, columns: tuple[str, ...]) -> str:
    """A table of a few rows, some cells of which are not numbers."""
    mark = chance.choice((",", ",", ",", ";", "\t"))
    wrong = chance.choice((0.0, 0.0, 0.01, 0.2))
    names = [chance.choice(CELLS) if chance.random() < wrong else name for name in columns]
    rows = [mark.join(names)]
    for k in range(chance.choice((0, 1, 2, 30))):
        cells = [f"{0.002 * k:.3f}", *(f"{chance.uniform(0.0, 1.0):.4f}" for _ in columns[1:])]
        rows.append(mark.join(chance.choice(CELLS) if chance.random() < wrong else cell for cell in cells))
    return "\n".join(rows) + chance.choice(("\n", "", "\r\n"))


def recorded(chance: random.Random) -> bytes:
    """A recording as CSV."""
    optional = [name for name in ("supply_voltage", "setpoint", "temperature", "enabled") if chance.random() < 0.2]
    quantity = chance.choice(("hall_voltage", "position"))
    return encoded(chance, table(chance, ("time", "duty", quantity, *optional)))


def scheduled(chance: random.Random) -> bytes:
    """A setpoint or a duty file."""
    return encoded(chance, table(chance, ("time", chance.choice(("setpoint", "duty")))))


def encoded(chance: random.Random, text: str) -> bytes:
    """The text, mutated most times, as bytes."""
    if chance.random() < 0.8:
        text = mutated_text(chance, text)
    if chance.random() < 0.01:
        text += chance.choice(("1" * 3_000_000, "1,2,3\n" * 300_000, '"' + "1,\n" * 500_000))
    encoding = chance.choice(("utf-8", "utf-8", "utf-8", "utf-8-sig", "utf-16"))
    return text.encode(encoding, "surrogateescape" if encoding != "utf-16" else "replace")
