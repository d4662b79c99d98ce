"""What mutations put in the place of a number, a text or a name: the ends of every range, and what is no number."""

import random

INTEGERS = (
    *(0, 1, 2, 7, 8, 9, 255, 256, 65_535, 65_536),
    *(2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**40, 2**62, 2**63 - 1, 2**63, 2**64 - 1),
)
FLOATS = (
    *(0.0, -0.0, 1.0, -1.0, 1e-320, 1e-300, 1e9, 1e12, 1e18, 1e150, 1e300, 1.7e308),
    *(float("nan"), float("inf"), float("-inf")),
)
CELLS = (
    *("", " ", "0", "-0", "1e400", "-1e400", "nan", "inf", "-Infinity", "1e300", "1e-320", "1_000", "0x10", "1,5"),
    *("9" * 400, "time", "duty", "\x00", "\x1b[2J", "[red]x", "<script>", '"', '""', "'", "\u2028", "\ud7ff", "=1+1"),
    *("1e18", "-1e18", "1e9", "9223372036.854775807", "18446744073.709551616"),
)
SCALARS = (
    *CELLS,
    *("null", "~", "true", "yes", "no", "2001-01-01", "2001-99-99", "12:30:45", "1:2:3:4:5:6", "0b11", "0o7", ".nan"),
    *(".inf", "-.inf", "!!float x", "!!int y", "!!binary aGk=", "!!python/object:os.system {}", "!!set {a, b}", "<<"),
    *("&a", "*a", "&a [*a]", "[]", "{}", "[1, 2]", "{a: 1}", "? a", "- 1", "|", ">", "%TAG ! x", "---", "..."),
    "9" * 5000,
)
NAMES = (
    *("", "/", "//", "/" * 300, "../../etc/passwd", "/dev/zero", "a" * 5000),
    *("\x00", "\x1b]0;x\x07", "[bold]", "$\\frac$"),
)


def integer(chance: random.Random) -> int:
    """A whole number from -2^64 to 2^64, most often the end of a range or beside it."""
    return chance.choice((1, 1, 1, -1)) * chance.choice(INTEGERS) + chance.choice((0, 0, 0, -1, 1))


def number(chance: random.Random) -> float:
    """A double, most often one that a bench never gives."""
    return chance.choice(FLOATS) if chance.random() < 0.7 else chance.gauss(0.0, 10.0 ** chance.randint(-5, 20))
