"""YAML as data: what it means, and what is refused before it is built."""

import math
import time

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.errors import InputError
from pierburg_ros.intake import parsed

plain = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**17), 10**17) | st.floats(allow_nan=False) | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=10), inner, max_size=4),
    max_leaves=20,
)


def content(text):
    return parsed(text, "model.yaml", "a model").content


def refusal(text) -> str:
    with pytest.raises(InputError) as refused:
        parsed(text, "model.yaml", "a model")
    return str(refused.value)


@given(plain)
def test_what_a_yaml_writer_writes_reads_back(value):
    assert content(yaml.safe_dump(value)) == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 1e-3),
        ("010", 10),
        ("'1'", "1"),
        ("12:30", "12:30"),
        ("2001-01-01", "2001-01-01"),
        ("9" * 400, math.inf),
        ("9" * 19, 1e19),
        ("-.inf", -math.inf),
        ("yes", "yes"),
        ("", None),
    ],
)
def test_scalars_mean_what_they_look_like(text, value):
    assert content(text) == value


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("a: 1\na: 2", "line 2 is not YAML (a given twice, expected each name once)"),
        ("[a]: 1", "a list or mapping as a name"),
        ("a: !!python/object:os.system {}", "the tag tag:yaml.org,2002:python/object:os.system"),
        ("a: !!float x", "the tag tag:yaml.org,2002:float"),
        ("a: &a [*a]", "a value that contains itself"),
        ("a: *b", "undefined alias"),
        ("a: 1\n---\nb: 2", "but found another document"),
        ("a: \x00", "characters that YAML does not allow"),
    ],
)
def test_refusals_name_line_and_reason(text, reason):
    assert reason in refusal(text)


@pytest.mark.parametrize("bracket", ["[", "{a: ", "- ", "? "])
@pytest.mark.parametrize("depth", [21, 100_000])
def test_deep_nesting_is_refused_at_once(bracket, depth):
    began = time.process_time()
    assert "deeply nested lists, expected at most 20 levels" in refusal(bracket * depth)
    assert time.process_time() - began < 5.0


def test_a_billion_laughs_are_counted_and_refused():
    lines = ["l0: &l0 [ha, ha]"] + [f"l{k}: &l{k} [{', '.join([f'*l{k - 1}'] * 9)}]" for k in range(1, 12)]
    assert "too many values, expected at most 50,000" in refusal("\n".join(lines))


def test_a_shared_value_is_read_where_it_is_meant():
    assert content("a: &x {b: [1]}\nc: [*x, *x]") == {"a": {"b": [1]}, "c": [{"b": [1]}, {"b": [1]}]}


def test_lines_of_values_are_known():
    document = parsed("a:\n  b: 1\n  c: 2\n", "model.yaml", "a model")
    assert document.line("a", "c") == " line 3"
    assert document.line() == " line 1"
