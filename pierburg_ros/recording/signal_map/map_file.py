"""Reads a signal map, YAML, and the names of `--topic`; what is wrong is one line with its place in the file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any, TypeAlias

from pierburg_ros.errors import InputError, near
from pierburg_ros.intake import Document, parsed, text_of
from pierburg_ros.recording.signal_map.field_path import FieldPath, field_path
from pierburg_ros.recording.signal_map.source import SignalMap, Source, TimeSource
from pierburg_ros.recording.signals import SIGNALS, TIME, signal_of
from pierburg_ros.recording.units import COUNTS, USUAL, Unit, unit_of

KEYS = ("topic", "field", "column", "file", "unit", "scale", "offset", "sign", "exact")
TIME_KEYS = ("topic", "field", "column", "unit")
TIME_UNITS = ("s", "ms", "us", "ns")
FORM = "expected {topic: /name, field: path} or {column: name}, with unit, scale, offset and sign where needed"
BARE = re.compile(r"(?P<key>\b(?:field|column|topic):[ \t]+)(?P<name>[^\s'\"\[{,}][^'\"{},\n]{0,300})(?=[,}])")
"""A name or a path between braces and without quotes."""
LARGEST_SCALE = 1e12
"""Largest magnitude of a scale, and with 1 over it the smallest: from pico to tera."""
MOST_FILES = 1000
"""Parts of a table at most."""


Given: TypeAlias = "str | Path | Mapping[str, Any] | SignalMap | None"
"""A signal map, the path of its file, or its content."""


def signal_map(given: Given, named: Mapping[str, str]) -> SignalMap:
    """The map that is `given`, with the topics or columns `named` by signal in place of its own."""
    found = given if isinstance(given, SignalMap) else SignalMap() if given is None else read_signal_map(given)
    sources, time = dict(found.sources), found.time
    for name, place in named.items():
        signal = signal_of(name)
        if signal == TIME:
            time = TimeSource(columns=(place,))
        elif signal in SIGNALS:
            sources[signal] = Source("either", place)
        else:
            raise InputError(
                f"--topic found the unknown signal {name}, expected one of {', '.join(SIGNALS)}, {TIME}."
                f"{near(name, SIGNALS)} Write --topic duty=/bench/pwm."
            )
    return replace(found, sources=sources, time=time, left_out=found.left_out - set(sources))


def read_signal_map(given: str | Path | Mapping[str, Any]) -> SignalMap:
    """The signal map in a file, or of its content."""
    if isinstance(given, Mapping):
        name, document = "signals", Document(dict(given), None)
    else:
        name, text = str(given), BARE.sub(quoted, text_of(given, "a signal map"))
        document = parsed(text, name, "a signal map")
    content = document.content
    if not isinstance(content, dict) or not content:
        raise InputError(f"{name} is no signal map, expected lines like 'duty: {{topic: /pwm, field: data}}'.")
    sources, time, left_out = {}, None, set()
    for signal, entered in content.items():
        entry = Entry(document, name, str(signal), entered)
        if signal == TIME:
            time = entry.time()
        elif signal not in SIGNALS:
            known = (*SIGNALS, TIME)
            raise InputError(f"{entry.origin} is no signal, expected one of {', '.join(known)}.{near(signal, known)}")
        elif entered is None:
            left_out.add(signal)
        else:
            sources[signal] = entry.source()
    return SignalMap(sources, time, frozenset(left_out))


def quoted(bare: re.Match[str]) -> str:
    """The same with quotes where it holds a bracket: YAML would begin a list there, and a person means the name."""
    name = bare["name"].rstrip()
    return f'{bare["key"]}"{name}"' if "[" in name and "\\" not in name else bare[0]


class Entry:
    """What a map gives for one signal, checked."""

    def __init__(self, document: Document, name: str, signal: str, given: Any) -> None:
        self.document = document
        self.name = name
        self.signal = signal
        self.given = given
        self.origin = self.place()

    def source(self) -> Source:
        """Where the signal comes from."""
        self.check_keys(KEYS)
        kind = self.kind()
        wanted = SIGNALS[self.signal].units
        unit, scale = self.unit(wanted), self.number("scale", 1.0, LARGEST_SCALE)
        if unit.written == COUNTS and "scale" not in self.given:
            raise self.wrong("unit", COUNTS, f"a scale too, in {wanted[0]} per count")
        if scale == 0.0 or abs(scale) < 1.0 / LARGEST_SCALE:
            raise self.wrong("scale", f"{scale:g}", f"another number than 0, up to {LARGEST_SCALE:g}")
        return Source(
            kind,
            self.text(kind),
            self.path(),
            unit.factor,
            scale,
            self.number("offset", 0.0, 1e9),
            self.sign(),
            self.files(),
            self.origin,
            "" if unit.written in (COUNTS, "1") else next(each for each in wanted if unit.measures(each)),
            "unit" in self.given or "scale" in self.given,
            unit.written if "unit" in self.given else "",
            self.exact(),
        )

    def time(self) -> TimeSource:
        """What the times of the samples are."""
        self.check_keys(TIME_KEYS)
        unit = self.unit(("s",))
        if "unit" in self.given and unit.written not in TIME_UNITS:
            raise self.wrong("unit", unit.written, self.units(("s",)))
        if self.kind() == "topic":
            return TimeSource(self.text("topic"), self.path(), (), unit.factor, self.origin)
        column = self.given["column"]
        if isinstance(column, list) and len(column) == 2 and all(isinstance(each, str) and each for each in column):
            return TimeSource(columns=tuple(column), origin=self.origin)
        return TimeSource(
            columns=(self.text("column"),), unit=unit.factor, origin=self.origin, scaled="unit" in self.given
        )

    def check_keys(self, known: tuple[str, ...]) -> None:
        """Refuse what is no mapping of the `known` keys."""
        if not isinstance(self.given, dict) or not self.given:
            raise InputError(f"{self.origin} has {shown(self.given)}, {FORM}.")
        for key in self.given:
            if key not in known:
                raise InputError(f"{self.place(key)} found the key {key!r}, {FORM}.{near(key, known)}")

    def kind(self) -> str:
        """Whether a topic or a column is given."""
        kinds = [kind for kind in ("topic", "column") if kind in self.given]
        if len(kinds) != 1:
            raise InputError(f"{self.origin} has {' and '.join(kinds) or 'neither topic nor column'}, {FORM}.")
        for key, belongs in (("field", "topic"), ("file", "column")):
            if key in self.given and kinds != [belongs]:
                raise InputError(f"{self.place(key)} found {key} with a {kinds[0]}, expected it with a {belongs}.")
        return kinds[0]

    def text(self, key: str) -> str:
        """The text under `key`; numbers stand for the columns that are called so."""
        value = self.given[key]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            value = str(value)
        if not isinstance(value, str) or not value:
            raise self.wrong(key, shown(value), f"the name of a {key}")
        return value

    def path(self) -> FieldPath | None:
        """The field path, where one is given."""
        if "field" not in self.given:
            return None
        try:
            return field_path(self.text("field"))
        except ValueError:
            raise self.wrong(
                "field", shown(self.given["field"]), "a path like pwm.data[2] or position[elbow]"
            ) from None

    def unit(self, wanted: tuple[str, ...]) -> Unit:
        """The unit, of what the signal measures."""
        if "unit" not in self.given:
            return unit_of("1")
        written = str(self.given["unit"]) if not isinstance(self.given["unit"], bool) else "true"
        try:
            unit = unit_of(written)
        except ValueError:
            fitting = [unit for unit in USUAL if any(unit_of(unit).measures(each) for each in wanted)]
            meant = [unit for unit in fitting if unit.lower() == written.lower()]
            hint = f" Did you mean {meant[0]}?" if meant else near(written, fitting)
            raise self.wrong("unit", shown(written), self.units(wanted), hint) from None
        if not any(unit.measures(each) for each in wanted):
            raise self.wrong("unit", written, self.units(wanted))
        return unit

    @staticmethod
    def units(wanted: tuple[str, ...]) -> str:
        """What to give as a unit."""
        if wanted == ("s",):
            return f"one of {', '.join(TIME_UNITS)}"
        examples = {
            "1": "1, percent",
            "rad": "rad, deg, mrad",
            "rad/s": "rad/s, rpm, deg/s",
        }
        return f"one of {' or '.join(examples.get(each, each) for each in wanted)} (also with SI prefixes), or counts"

    def number(self, key: str, default: float, largest: float) -> float:
        """The finite number under `key`."""
        value = self.given.get(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self.wrong(key, shown(value), "a finite number")
        if abs(value) > largest:
            raise self.wrong(key, f"{value:g}", f"a magnitude up to {largest:g}")
        return float(value)

    def sign(self) -> int:
        """1 or -1."""
        value = self.given.get("sign", 1)
        if isinstance(value, bool) or value not in (1, -1):
            raise self.wrong("sign", shown(value), "1 or -1")
        return int(value)

    def exact(self) -> bool:
        """Whether the signal is what it is read as, by the word of a person."""
        value = self.given.get("exact", False)
        if not isinstance(value, bool):
            raise self.wrong("exact", shown(value), "true or false")
        return value

    def files(self) -> tuple[str, ...]:
        """Names of files in the folder of the recording."""
        given = self.given.get("file", [])
        names = given if isinstance(given, list) else [given]
        right = all(isinstance(name, str) and name and PurePath(name).name == name for name in names)
        if not right or len(names) > MOST_FILES or len(set(map(str, names))) < len(names):
            raise self.wrong(
                "file", shown(given), "the name of a CSV in the folder of the recording, or a list of them"
            )
        return tuple(names)

    def place(self, *key: str) -> str:
        """Where the signal, or a key of it, stands."""
        return f"{self.name}{self.document.line(self.signal, *key)}: {self.signal}"

    def wrong(self, key: str, found: str, expected: str, hint: str = "") -> InputError:
        """What to say of the value under `key`."""
        return InputError(f"{self.place(key)} found the {key} {found}, expected {expected}.{hint}")


def shown(value: Any) -> str:
    """A value in a message, cut short."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
