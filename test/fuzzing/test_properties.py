"""Readers under inputs that Hypothesis makes up: what is right reads back, all else is one line."""

import struct
import tempfile
from pathlib import Path

import numpy as np
import yaml
from fuzzing.mcap_input import MAGIC, message, record, text
from hypothesis import example, given
from hypothesis import strategies as st

from pierburg_ros.actuators import read_actuator
from pierburg_ros.control import read_parameter_file, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.plant.model_file import read_model
from pierburg_ros.recording import read_recording

doubles = st.floats(width=64)
times = st.integers(0, 2**64 - 1)
samples = st.lists(st.tuples(times, doubles), min_size=1, max_size=8)
cells = st.one_of(doubles.map(str), st.sampled_from(["", "nan", "1e400", '"', "time", "\x00"]), st.text(max_size=5))
rows = st.lists(st.lists(cells, min_size=3, max_size=3), max_size=6)
words = st.one_of(st.text(max_size=8), doubles, st.integers(), st.booleans(), st.none(), st.dates().map(str))
trees = st.recursive(words, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3))


def ends_well(name: str, content: bytes, read) -> object:
    """The result, or None after one printable line."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        try:
            return read(path)
        except InputError as error:
            line = str(error)
            assert len(line) <= 300 and line.isprintable()
            return None


@given(st.binary(max_size=300))
def test_any_bytes_as_an_mcap(content):
    ends_well("run.mcap", MAGIC + content, read_recording)


@given(st.lists(st.tuples(st.integers(0, 255), st.binary(max_size=60)), max_size=6))
def test_any_records_as_an_mcap(records):
    ends_well("run.mcap", MAGIC + b"".join(record(opcode, content) for opcode, content in records), read_recording)


@given(samples, samples)
@example([(0, 0.0), (10**9, 1.0)], [(0, 0.5), (10**9, 0.5)])
def test_any_samples_as_an_mcap(hall, duty):
    content = MAGIC + record(3, struct.pack("<H", 1) + text("std_msgs/msg/Float64") + text("ros2msg") + text(""))
    for number, (topic, sent) in enumerate((("/hall_voltage", hall), ("/duty", duty)), 1):
        channel = struct.pack("<HH", number, 1) + text(topic) + text("cdr") + struct.pack("<I", 0)
        content += record(4, channel)
        for k, (when, value) in enumerate(sent):
            data = b"\0\1\0\0" + struct.pack("<d", value)
            content += record(5, message(number, k, when, when, data))
    found = ends_well("run.mcap", content, read_recording)
    if found is not None:
        assert np.all(np.diff(found.time) >= 0.0) and np.all(np.abs(found.measured) <= 1e9)


@given(rows)
def test_any_cells_as_a_csv(table):
    lines = ["time,duty,hall_voltage", *(",".join(row) for row in table)]
    content = "\n".join(lines).encode("utf-8", "surrogatepass")
    ends_well("run.csv", content, read_recording)
    ends_well("setpoints.csv", content.replace(b",hall_voltage", b"").replace(b"duty", b"setpoint"), read_setpoint_file)


@given(trees)
def test_any_tree_as_a_model_an_actuator_and_settings(tree):
    for section in ("parameters", "effects", "residual_torque"):
        wrapped = {"actuator": "pierburg", section: tree}
        content = yaml.safe_dump(wrapped).encode("utf-8", "surrogatepass")
        ends_well("model.yaml", content, read_model)
    settings = {"controller": {"ros__parameters": tree}}
    ends_well("controller.yaml", yaml.safe_dump(settings).encode("utf-8", "surrogatepass"), read_parameter_file)
    ends_well("actuator.yaml", yaml.safe_dump(tree).encode("utf-8", "surrogatepass"), read_actuator)
