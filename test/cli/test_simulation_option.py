"""`--simulation` of `pierburg diagnose` from the command line: its values, and refusals before any work."""

import pytest

from pierburg_ros.cli.app import main, spread

ROWS = "".join(f"{0.01 * sample},{0.2 if sample > 100 else 0.0},{0.42 + 0.001 * sample}\n" for sample in range(300))


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Three recordings in the current folder."""
    monkeypatch.chdir(tmp_path)
    for name in ("real.csv", "one.csv", "two.csv"):
        (tmp_path / name).write_text("time,duty,hall_voltage\n" + ROWS)
    return tmp_path


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["diagnose", *arguments])
    return ending.value.code


class Asked(Exception):
    """What the diagnosis was asked for."""


@pytest.mark.parametrize(
    "arguments",
    [
        ("real.csv", "--simulation", "one.csv", "two.csv", "--output", "out"),
        ("--simulation", "one.csv", "two.csv", "--output", "out", "real.csv"),
        ("real.csv", "--simulation", "one.csv", "--simulation", "two.csv", "--output", "out"),
        ("real.csv", "--output", "out", "--simulation=one.csv", "two.csv"),
    ],
)
def test_all_up_to_the_next_option_are_recordings_of_the_simulator(files, monkeypatch, arguments):
    def asked(recordings, simulation, **_):
        raise Asked([each.name for each in recordings], [each.name for each in simulation])

    monkeypatch.setattr("pierburg_ros.library.diagnosing.diagnose", asked)
    with pytest.raises(Asked) as question:
        main(["diagnose", *arguments])
    assert question.value.args == (["real.csv"], ["one.csv", "two.csv"])


def test_other_options_keep_their_values():
    given = ["diagnose", "a", "--topic", "duty=/x", "--topic", "hall=/y", "--output", "o"]
    assert spread(given) == given


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("real.csv", "--output", "out", "--simulation", "none.csv"), "none.csv"),
        (("--output", "out", "--simulation", "one.csv", "real.csv"), "Missing argument '"),
        (("real.csv", "--output", "out", "--simulation-signals", "m.yaml"), "without --simulation"),
        (("real.csv", "--output", "out", "--thorough", "--budget", "1"), "Found --thorough with --budget"),
    ],
)
def test_bad_input_is_one_line_and_status_2(files, capsys, arguments, line):
    assert run(*arguments) == 2
    error = capsys.readouterr().err
    assert line in error and error.count("\n") == 1
    assert not (files / "out").exists()


def test_a_map_that_does_not_suit_the_simulator_is_told_from_one_of_its_own(files, capsys):
    renamed = (files / "real.csv").read_text().replace("duty", "pwm")
    (files / "real.csv").write_text(renamed)
    (files / "m.yaml").write_text("duty: {column: pwm}\n")
    assert run("real.csv", "--signals", "m.yaml", "--output", "out", "--simulation", "one.csv") == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "one.csv has no column pwm" in said and "--simulation-signals FILE" in said
