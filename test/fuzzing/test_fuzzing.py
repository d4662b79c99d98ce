"""2,000 inputs that are nearly right end in a result or one line; benchmarks/fuzz.py tries 200,000."""

import tempfile
from pathlib import Path

import pytest
from fuzzing.trial import KINDS, case, tried

COUNT = 2000
PARTS = 16


@pytest.mark.parametrize("part", range(PARTS))
def test_every_input_ends_in_a_result_or_one_line(part):
    outcomes = []
    for seed in range(part * COUNT // PARTS, (part + 1) * COUNT // PARTS):
        with tempfile.TemporaryDirectory() as folder:
            outcomes.append(tried(seed, Path(folder)))
    assert [outcome for outcome in outcomes if not outcome.well] == []
    assert {outcome.how for outcome in outcomes} == {"result", "line"}


def test_an_input_is_the_same_whenever_it_is_made():
    assert all(case(seed)[1] == case(seed)[1] for seed in range(2 * len(KINDS)) if case(seed)[0].name != "run.db3")
