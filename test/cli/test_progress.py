"""Progress on the standard error: stage, count, best, time left; a line now and then where it is no terminal."""

import io

import pytest
from rich.console import Console

from pierburg_ros.cli.console import progress as shown
from pierburg_ros.cli.console.progress import Log, Step, duration
from pierburg_ros.cli.console.terminal import loudness


@pytest.fixture
def log(monkeypatch):
    """A log, its text, and a clock that is set by hand [s]."""
    now = [100.0]
    monkeypatch.setattr(shown.time, "monotonic", lambda: now[0])
    console = Console(file=io.StringIO(), width=200)
    return Log(console), console.file, now


def test_a_step_says_how_many_of_how_many_the_best_and_the_time_left():
    step = Step("searching", 12, 40, "error 3.2 times the noise", 45.0)
    assert step.words == "12 of about 40, error 3.2 times the noise, about 45 s left"
    assert Step("searching", 12).words == Step("searching", 12, 12).words == "12 tried"
    assert Step("searching").words == ""


def test_the_time_left_follows_from_the_pace_unless_it_is_told():
    assert Step("searching", 10, 40).timed(20.0).left == pytest.approx(60.0)
    assert Step("searching", 10, 40, left=5.0).timed(20.0).left == 5.0
    assert Step("searching", 10).timed(20.0).left is None
    assert Step("searching", 1, 4).timed(0.0).left is None


def test_a_log_has_a_line_for_each_stage_and_one_now_and_then(log):
    tell, text, now = log
    for number in range(1000):
        now[0] += 0.03
        tell(Step("searching", number, 1000))
    tell(Step("judging"))
    lines = text.getvalue().splitlines()
    assert lines[0].startswith("searching: 0 of about 1000") and lines[-1] == "judging"
    assert len(lines) == 2 + 30 // shown.SELDOM - 1


def test_a_silent_command_shows_no_progress(capsys):
    with loudness(results=True, progress=False), shown.progress() as tell:
        tell(Step("searching"))
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(("seconds", "words"), [(4.4, "4 s"), (240.0, "4 min"), (9000.0, "2.5 h")])
def test_times_are_for_people(seconds, words):
    assert duration(seconds) == words
