"""Signal maps beside tables and bags of foreign types, whose definitions are nearly right too."""

from __future__ import annotations

import io
import random
import re
from functools import cache
from typing import Any

from fuzzing.mutations import mutated_text
from fuzzing.table_input import encoded, table
from fuzzing.values import SCALARS
from fuzzing.yaml_input import text_of
from mcap.writer import CompressionType, Writer
from support.foreign_bags import STORE, bench_run

COLUMNS = ("t", "pwm", "adc", "vbat")
TABLE_MAP = """duty: {column: pwm, unit: percent, sign: -1}
hall_voltage: {column: adc, unit: counts, scale: 0.0008056640625, offset: 0.1}
supply_voltage: {column: vbat, file: run.csv}
time: {column: t, unit: ms}
temperature: null
"""
BAG_MAP = """duty: {topic: /motor/command, field: "pwm.data[2]", unit: percent}
position: {topic: /joint_states, field: "position[elbow]", unit: deg, sign: -1, offset: 1.5708}
supply_voltage: {topic: /board, field: "channels[supply].volts"}
time: {topic: /motor/command, field: micros, unit: us}
"""
VALUE = re.compile(r": ([^{},]+)(?=[,}\n])")
PATHS = (
    *("data", "position", "position[0]", "position[99]", "position[shoulder]", "position[999999999999]", "pwm.data"),
    *("pwm", "header", "header.stamp", "header.stamp.sec", "channels", "channels[0]", "channels[spare].name", "note"),
    *("micros[0]", "a.b.c[d].e[0][0]", "class", "__class__", "x" * 400, "pwm.data[2].x", "run.csv", "[run.csv, a.csv]"),
    *(
        "ms",
        "us",
        "rpm",
        "deg",
        "V",
        "counts",
        "N.m",
        "1e-3",
        "[t, vbat]",
        "/board",
        "/joint_states",
        "adc",
        "../run.csv",
    ),
)
TOPICS = {
    "/motor/command": "bench/msg/Command",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/board": "bench/msg/Board",
}


def map_of(chance: random.Random, text: str) -> bytes:
    """A map: as it is, with a few other values, or mutated as a text."""
    if chance.random() < 0.3:
        return text_of(chance, text)
    for _ in range(chance.choice((0, 1, 1, 2))):
        value = chance.choice(list(VALUE.finditer(text)))
        text = text[: value.start(1)] + chance.choice((*SCALARS, *PATHS)) + text[value.end(1) :]
    return text.encode("utf-8", "surrogateescape")


def mapped_table(chance: random.Random) -> dict[str, bytes]:
    """A table and its map."""
    rows = table(chance, COLUMNS)
    return {
        "signals.yaml": map_of(chance, TABLE_MAP),
        "run.csv": encoded(chance, rows) if chance.random() < 0.2 else rows.encode("utf-8", "surrogateescape"),
    }


def mapped_bag(chance: random.Random) -> dict[str, bytes]:
    """An MCAP file of foreign types and its map; of one of the types another definition, most times."""
    topic = chance.choice(list(TOPICS))
    definition = definitions()[TOPICS[topic]]
    if chance.random() < 0.5:
        definition = mutated_text(chance, definition)
    return {"signals.yaml": map_of(chance, BAG_MAP), "run.mcap": bag(TOPICS[topic], definition)}


@cache
def definitions() -> dict[str, str]:
    """The text of each type and of all that it holds."""
    return {name: str(STORE.generate_msgdef(name, ros_version=2)[0]) for name in TOPICS.values()}


@cache
def contents() -> list[tuple[str, int, bytes]]:
    """Topic, time [ns] and CDR of the messages."""
    return [
        (topic, round(time * 1e9), bytes(STORE.serialize_cdr(content, kind)))
        for topic, kind, time, content in bench_run(10)
    ]


def bag(changed: str, definition: str) -> bytes:
    """An MCAP file in which the type `changed` has another definition."""
    stream = io.BytesIO()
    writer = Writer(stream, compression=CompressionType.NONE)
    writer.start(profile="ros2", library="test")
    channels: dict[str, Any] = {}
    for topic, kind in TOPICS.items():
        text = definition if kind == changed else definitions()[kind]
        schema = writer.register_schema(kind, "ros2msg", text.encode("utf-8", "surrogateescape"))
        channels[topic] = writer.register_channel(topic, "cdr", schema)
    for topic, time, data in contents():
        writer.add_message(channels[topic], time, data, time)
    writer.finish()
    return stream.getvalue()
