"""A proof on real recordings counts effort, so that its results are those of any machine."""

import pytest

from pierburg_ros.cli.prove_real import efforts
from pierburg_ros.errors import InputError


@pytest.mark.parametrize(("given", "meant"), [("", 1.0), ("2", 2.0), ("0.5", 0.5)])
def test_usual_efforts_are_taken(given, meant):
    assert efforts(given) == meant


def test_seconds_are_refused():
    with pytest.raises(InputError, match=r"--budget is 60s; expected usual efforts"):
        efforts("60s")
