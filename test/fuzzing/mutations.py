"""Mutations of bytes and of text; each takes a generator and content, and gives other content."""

import random

from fuzzing.values import SCALARS, integer

LARGEST = 1 << 20
"""Bytes of an input at most, bombs aside: a mutation that would make it longer is left out."""


def mutated_bytes(chance: random.Random, content: bytes) -> bytes:
    """`content` after one to four mutations that know nothing of its form."""
    for _ in range(chance.randint(1, 4)):
        other = chance.choice(BYTES)(chance, bytearray(content))
        content = bytes(other) if len(other) <= LARGEST else content
    return content


def place(chance: random.Random, content: bytes | bytearray | str) -> int:
    """A place in `content`, or its end."""
    return chance.randint(0, len(content))


def flipped(chance: random.Random, content: bytearray) -> bytearray:
    """One bit the other way round."""
    if content:
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    return content


def overwritten(chance: random.Random, content: bytearray) -> bytearray:
    """A whole number of 1 to 8 bytes written over what was there."""
    size = chance.choice((1, 2, 4, 8))
    start = place(chance, content)
    content[start : start + size] = (integer(chance) % (1 << 8 * size)).to_bytes(size, "little")
    return content


def cut(chance: random.Random, content: bytearray) -> bytearray:
    """Without a stretch, or without its end."""
    start = place(chance, content)
    del content[start : None if chance.random() < 0.4 else start + chance.randint(1, 64)]
    return content


def repeated(chance: random.Random, content: bytearray) -> bytearray:
    """With a stretch several times."""
    start = place(chance, content)
    stretch = content[start : start + chance.randint(1, 200)]
    content[start:start] = stretch * chance.choice((1, 2, 50))
    return content


def inserted(chance: random.Random, content: bytearray) -> bytearray:
    """With random bytes in between."""
    start = place(chance, content)
    content[start:start] = chance.randbytes(chance.randint(1, 64))
    return content


BYTES = (flipped, flipped, overwritten, overwritten, cut, repeated, inserted)


def mutated_text(chance: random.Random, text: str) -> str:
    """`text` after one to four mutations of its lines and words."""
    for _ in range(chance.randint(1, 4)):
        other = chance.choice(TEXT)(chance, text)
        text = other if len(other) <= LARGEST else text
    return text


def other_word(chance: random.Random, text: str) -> str:
    """Another word in the place of one."""
    words = [word for word in text.replace(",", " ").replace("{", " ").replace("}", " ").split() if word]
    if not words:
        return text
    parts = text.split(chance.choice(words))
    cut_at = chance.randrange(1, len(parts)) if len(parts) > 1 else 1
    word = parts[0:0] or chance.choice(SCALARS)
    return _joined(text, parts, cut_at, str(word))


def _joined(text: str, parts: list[str], cut_at: int, word: str) -> str:
    if len(parts) < 2:
        return text + word
    gone = len(text) - sum(len(part) for part in parts)
    separator = text[len(parts[0]) : len(parts[0]) + gone // (len(parts) - 1)]
    return separator.join(parts[:cut_at]) + word + separator.join(parts[cut_at:])


def lines_changed(chance: random.Random, text: str) -> str:
    """A line dropped, doubled, swapped with another or indented."""
    lines = text.split("\n")
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    how = chance.randrange(4)
    if how == 0:
        del lines[at]
    elif how == 1:
        lines[at:at] = [lines[other]] * chance.choice((1, 1, 100))
    elif how == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = " " * chance.choice((1, 2, 3, 300)) + lines[at]
    return "\n".join(lines)


def nested(chance: random.Random, text: str) -> str:
    """With brackets nested deeply."""
    at = place(chance, text)
    opening, closing = chance.choice((("[", "]"), ("{a: ", "}"), ("- ", ""), ("? ", ""), ("(", ")"), ('"', '"')))
    depth = chance.choice((3, 30, 300, 3000, 20_000))
    return text[:at] + opening * depth + closing * depth + text[at:]


def laughing(chance: random.Random, text: str) -> str:
    """With aliases of aliases: short to write, endless to walk."""
    levels, wide = chance.choice((3, 9, 30)), chance.choice((2, 9))
    lines = ["l0: &l0 [1, 2]"]
    lines += [f"l{k}: &l{k} [{', '.join([f'*l{k - 1}'] * wide)}]" for k in range(1, levels)]
    return "\n".join(lines) + "\n" + text


def inserted_text(chance: random.Random, text: str) -> str:
    """With a word in between, once or very often."""
    at = place(chance, text)
    return text[:at] + chance.choice(SCALARS) * chance.choice((1, 1, 1, 1000)) + text[at:]


def bytes_of_text(chance: random.Random, text: str) -> str:
    """Mutated as bytes, which need not be text after that."""
    return mutated_bytes(chance, text.encode("utf-8", "surrogatepass")).decode("utf-8", "surrogateescape")


TEXT = (
    other_word,
    other_word,
    other_word,
    other_word,
    lines_changed,
    lines_changed,
    inserted_text,
    nested,
    bytes_of_text,
)
