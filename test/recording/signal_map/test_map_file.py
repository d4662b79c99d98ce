"""A map says where each signal comes from; a bad one is refused in one line with its place in the file."""

import math

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.recording.signal_map import read_signal_map, signal_map


@pytest.fixture
def read(tmp_path):
    """Reads the text of a map."""

    def reading(text):
        path = tmp_path / "signals.yaml"
        path.write_text(text)
        return read_signal_map(path)

    return reading


def test_the_example_of_the_contract(read):
    found = read(
        """duty:           {topic: /motor/command, field: pwm.data[2], scale: 0.01}          # percent
position:       {topic: /joint_states, field: "position[elbow]", unit: deg, sign: -1, offset: 1.5708}
hall_voltage:   {topic: /adc, field: data, scale: 0.0008056640625}                # counts of 12 bit over 3.3 V
supply_voltage: {column: vbat}
time:           {column: t, unit: ms}
"""
    )
    assert found.sources["duty"].name == "/motor/command" and found.sources["duty"].path.written == "pwm.data[2]"
    position = found.sources["position"]
    assert (position.unit, position.sign, position.offset) == (pytest.approx(math.pi / 180), -1, 1.5708)
    assert found.sources["supply_voltage"].kind == "column"
    assert found.time.columns == ("t",) and found.time.unit == 1e-3


def test_the_value_is_sign_times_unit_times_scale_times_raw_plus_offset(read):
    source = read("position: {column: p, unit: deg, sign: -1, scale: 0.5, offset: 0.25}\n").sources["position"]
    np.testing.assert_allclose(source.values(np.array([0.0, 90.0])), [0.25, 0.25 - math.pi / 4], rtol=1e-15)


def test_names_with_brackets_need_no_quotes(read):
    found = read("duty: {topic: /m, field: pwm.data[2], scale: 0.01}\nhall_voltage: {column: U [V] }\n")
    assert found.sources["duty"].path.written == "pwm.data[2]" and found.sources["duty"].scale == 0.01
    assert found.sources["hall_voltage"].name == "U [V]"
    block = read("hall_voltage:\n  column: U [V]\n  unit: mV\ntime: {column: [sec, nanosec]}\n")
    assert block.sources["hall_voltage"].name == "U [V]" and block.time.columns == ("sec", "nanosec")


def test_a_column_may_be_called_by_a_number(read):
    assert read("duty: {column: 3}\n").sources["duty"].name == "3"


def test_a_signal_may_be_left_out(read):
    assert read("duty: {column: pwm}\ntemperature: null\n").left_out == {"temperature"}


def test_an_option_stands_in_place_of_the_map(read):
    chosen = signal_map(read("duty: {topic: /a, unit: percent}\ntemperature: null\n"), {"duty": "/b", "time": "t"})
    assert chosen.sources["duty"].name == "/b" and chosen.sources["duty"].unit == 1.0
    assert chosen.time.columns == ("t",)


@pytest.mark.parametrize(("name", "signal"), [("joint_states", "position"), ("setpoint", "setpoints")])
def test_a_topic_or_column_s_own_name_stands_for_its_signal(name, signal):
    assert set(signal_map(None, {name: "/x"}).sources) == {signal}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is no signal map, expected lines like"),
        ("- duty\n", "is no signal map, expected lines like"),
        ("dutty: {topic: /a}\n", "line 1: dutty is no signal, expected one of duty, applied_duty"),
        ("dutty: {topic: /a}\n", "Did you mean duty?"),
        ("duty: /a\n", "line 1: duty has '/a', expected {topic: /name, field: path} or {column: name}"),
        ("duty: {}\n", "line 1: duty has {}, expected"),
        ("duty: {field: data}\n", "line 1: duty has neither topic nor column, expected"),
        ("duty: {topic: /a, column: b}\n", "line 1: duty has topic and column, expected"),
        ("duty: {column: a, field: b}\n", "line 1: duty found field with a column, expected it with a topic."),
        ("duty: {topic: /a, file: b.csv}\n", "line 1: duty found file with a topic, expected it with a column."),
        ("duty:\n  topic: /a\n  scal: 2\n", "line 3: duty found the key 'scal', expected"),
        ("duty:\n  topic: /a\n  scal: 2\n", "Did you mean scale?"),
        ("duty:\n  topic: /a\n  scale: 0\n", "line 3: duty found the scale 0, expected another number than 0"),
        ("duty: {topic: /a, scale: 1.0e-30}\n", "duty found the scale 1e-30, expected another number than 0"),
        ("duty: {topic: /a, scale: .nan}\n", "duty found the scale nan, expected a finite number."),
        ("duty: {topic: /a, scale: 1.0e+300}\n", "duty found the scale 1e+300, expected a magnitude up to 1e+12."),
        ("duty: {topic: /a, scale: two}\n", "duty found the scale 'two', expected a finite number."),
        ("duty: {topic: /a, scale: true}\n", "duty found the scale True, expected a finite number."),
        ("duty: {topic: /a, offset: .inf}\n", "duty found the offset inf, expected a finite number."),
        ("duty: {topic: /a, sign: 0}\n", "duty found the sign 0, expected 1 or -1."),
        ("duty: {topic: /a, sign: true}\n", "duty found the sign True, expected 1 or -1."),
        ("duty: {topic: /a, unit: furlong}\n", "duty found the unit 'furlong', expected one of 1, percent"),
        ("hall_voltage: {topic: /a, unit: mv}\n", "Did you mean mV?"),
        ("position: {topic: /a, unit: degs}\n", "Did you mean deg?"),
        ("duty: {topic: /a, unit: deg}\n", "duty found the unit deg, expected one of 1, percent"),
        ("position: {topic: /a, unit: rpm}\n", "position found the unit rpm, expected one of rad, deg, mrad or m"),
        ("hall_voltage: {topic: /a, unit: counts}\n", "the unit counts, expected a scale too, in V per count."),
        ("duty: {topic: [a]}\n", "line 1: duty found the topic ['a'], expected the name of a topic."),
        ("duty: {topic: /a, field: 'x..y'}\n", "duty found the field 'x..y', expected a path like pwm.data[2]"),
        ("duty: {column: a, file: ../b.csv}\n", "the file '../b.csv', expected the name of a CSV in the folder"),
        ("duty: {column: a, file: [b.csv, b.csv]}\n", "expected the name of a CSV in the folder"),
        ("time: {column: t, unit: min}\n", "time found the unit min, expected one of s, ms, us, ns."),
        ("time: {column: t, unit: V}\n", "time found the unit V, expected one of s, ms, us, ns"),
        ("time: {column: [a, b, c]}\n", "time found the column ['a', 'b', 'c'], expected the name of a column."),
        ("time: {column: t, scale: 2}\n", "time found the key 'scale', expected"),
        ("time: null\n", "line 1: time has None, expected"),
        ("duty: {topic: /a}\nduty: {topic: /b}\n", "line 2 is not YAML (duty given twice, expected each name once)"),
    ],
)
def test_a_bad_map_is_one_line(read, text, said):
    with pytest.raises(InputError) as refused:
        read(text)
    assert said in str(refused.value) and "\n" not in str(refused.value)


def test_a_map_may_be_given_as_a_mapping():
    found = signal_map({"duty": {"topic": "/a", "field": "data[2]"}, "temperature": None}, {})
    assert found.sources["duty"].path.written == "data[2]" and found.left_out == {"temperature"}
    with pytest.raises(InputError, match=r"^signals: duty found the scale 0, expected another number"):
        signal_map({"duty": {"topic": "/a", "scale": 0}}, {})


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="does not exist, expected a signal map"):
        read_signal_map(tmp_path / "no.yaml")
