"""A run on real recordings with a stand-in for the diagnosis: blind, sealed, resumable, counted, reported."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model
from pierburg_ros.proof.real import conduct, document, run
from pierburg_ros.proof.real.channels import write
from pierburg_ros.proof.real.machine import machine_in
from pierburg_ros.proof.real.trial import Trial
from pierburg_ros.recording import Channel, Recording, read_recording

COMMAND = (sys.executable, str(Path(__file__).parents[2] / "support" / "fake_diagnosis.py"))
TIME = np.arange(300) * 0.01


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """The file in which the stand-in writes down each request; sources stand still."""
    path = tmp_path / "asked.txt"
    monkeypatch.setenv("ASKED", str(path))
    monkeypatch.setattr(run, "source_version", lambda: "these")
    return path


@pytest.fixture
def machine(tmp_path):
    """Two recordings of a valve."""
    for k, name in enumerate(("first", "second")):
        hall = 0.001 * np.round(1000.0 * (1.5 + np.sin((3.0 + k) * TIME)))
        duty = Channel(TIME, 0.4 * np.sign(np.sin(5.0 * TIME)))
        write(tmp_path / "bench" / f"{name}.mcap", Recording(name, "hall_voltage", TIME, hall, duty))
    return machine_in(tmp_path / "bench", Model.nominal(read_actuator("pierburg")), read_recording)


def prove(output, plan, **options):
    return run.prove(output, plan, 30.0, workers=1, command=COMMAND, **options)


def test_models_come_first_then_untouched_recordings_then_the_levels(tmp_path, machine, asked):
    plan = run.planned(machine, ["sensor_lag", "armature_resistance"], ["half", "plain"])
    results = prove(tmp_path / "run", plan)
    lines = asked.read_text().splitlines()
    assert lines[0] == "second.mcap ['model.yaml', 'second.mcap']"
    assert lines[1] == "first.mcap ['first.mcap', 'model.yaml']"
    assert set(lines[2:]) == {"recording.mcap ['model.yaml', 'recording.mcap']"}
    # a level of half the limit does not exist where nothing is ruled out
    assert [result["name"] for result in results] == [
        "first-untouched",
        "second-untouched",
        "first-sensor_lag-plain",
        "first-armature_resistance-plain",
        "second-sensor_lag-plain",
        "second-armature_resistance-plain",
        "first-armature_resistance-half",
        "second-armature_resistance-half",
    ]


def test_a_run_goes_on_where_it_stopped(tmp_path, machine, asked):
    prove(tmp_path / "run", run.planned(machine, ["sensor_lag"], ["plain"], most=1))
    assert len(asked.read_text().splitlines()) == 3
    results = prove(tmp_path / "run", run.planned(machine, ["sensor_lag", "input_delay"], ["plain"], most=1))
    assert len(asked.read_text().splitlines()) == 4
    assert [result["kind"] for result in results] == ["untouched", "sensor_lag", "input_delay"]
    lines = (tmp_path / "run" / "results.jsonl").read_text().splitlines()
    assert [json.loads(line)["name"] for line in lines] == [result["name"] for result in results]


def test_results_of_other_sources_do_not_count(tmp_path, machine, asked, monkeypatch):
    plan = run.planned(machine, ["untouched"], most=1)
    prove(tmp_path / "run", plan)
    monkeypatch.setattr(run, "source_version", lambda: "others")
    prove(tmp_path / "run", plan)
    assert len(asked.read_text().splitlines()) == 4


def test_a_model_that_is_known_is_not_diagnosed(tmp_path, machine, asked):
    known = machine_in(tmp_path / "bench", machine.described, read_recording, known=True)
    prove(tmp_path / "run", run.planned(known, ["untouched"], most=1))
    assert len(asked.read_text().splitlines()) == 1


def test_an_effect_that_is_named_is_counted_with_its_value(tmp_path, machine, asked, monkeypatch):
    plan = run.planned(machine, ["sensor_lag"], ["plain"], most=1)
    prove(tmp_path / "run", run.planned(machine, ["untouched"], most=1))
    lag = {"id": "sensor_lag", "parameters": {"time_constant": {"value": 0.03}}}
    monkeypatch.setenv("ANSWER", json.dumps({"verdict": "missing_physics", "effects": [lag]}))
    untouched, lagged = prove(tmp_path / "run", plan)
    assert not untouched["beside"] and lagged["named"] and lagged["within"] and not lagged["already"]
    done = document.Run([untouched, lagged], plan)
    shares = document.headline(done)
    # the made-up signal is far from what a valve does, and a lag moves it by less
    assert lagged["shown"] is False and untouched["shown"] is None
    assert str(shares["Effect put in at plain strength, shown or not: named"]).startswith("1/1")
    assert str(shares["Effect put in at plain strength, and shown: named"]) == "n = 0"
    seen = document.headline(document.Run([untouched, {**lagged, "shown": True}], plan))
    assert str(seen["Effect put in at plain strength, and shown: named"]).startswith("1/1")
    assert str(shares["Untouched recordings given one more effect (false alarms)"]).startswith("0/1")
    docs = tmp_path / "docs.md"
    docs.write_text("# Proof\n\nIntroduction.\n")
    document.write(done, tmp_path / "run", docs)
    assert "first-sensor_lag-plain | 0.0" in docs.read_text() and docs.read_text().startswith("# Proof")
    assert "n = 2 of at most 2 planned trials" in (tmp_path / "run" / "proof-real.md").read_text()


@pytest.mark.parametrize("name", ["truth.json", "recording.mcap", "model.yaml"])
def test_what_is_changed_after_sealing_is_refused(tmp_path, machine, asked, name):
    prove(tmp_path / "run", run.planned(machine, ["untouched"], most=1))
    trial, bench = Trial("first", 0), conduct.Bench(tmp_path / "run", "these", 30.0, COMMAND)
    with (bench.folder(trial) / name).open("ab") as file:
        file.write(b" ")
    with pytest.raises(InputError, match=f"{name} is not what was sealed"):
        conduct.judge(trial, bench)


def test_a_diagnosis_that_fails_is_a_trial_without_an_answer(tmp_path, machine, asked, monkeypatch):
    prove(tmp_path / "run", run.planned(machine, ["untouched"], most=1))
    monkeypatch.setenv("DIAGNOSIS", "fails")
    _, result = prove(tmp_path / "run", run.planned(machine, ["sensor_lag"], ["plain"], most=1))
    assert result["failure"].endswith("status 1: cannot tell") and not result["named"]


def test_nothing_is_put_into_a_recording_that_gives_no_answer_as_it_is(tmp_path, machine, asked, monkeypatch):
    known = machine_in(tmp_path / "bench", machine.described, read_recording, known=True)
    monkeypatch.setenv("DIAGNOSIS", "fails")
    results = prove(tmp_path / "run", run.planned(known, ["sensor_lag"], most=1))
    assert [result["kind"] for result in results] == ["untouched"]


def test_an_unknown_kind_or_level_is_refused(machine):
    with pytest.raises(InputError, match=r"found kind 'rust', expected one of untouched, input_delay, .* for pierburg"):
        run.planned(machine, ["rust"])
    with pytest.raises(InputError, match="found level 'huge', expected one of plain, between, limit, half"):
        run.planned(machine, [], ["huge"])


def test_a_folder_of_other_recordings_is_refused(tmp_path, machine, asked):
    run.begin(tmp_path / "run", run.planned(machine), 30.0)
    (tmp_path / "bench" / "second.mcap").rename(tmp_path / "bench" / "third.mcap")
    other = machine_in(tmp_path / "bench", machine.described, read_recording)
    with pytest.raises(InputError, match="holds a run on other recordings"):
        run.begin(tmp_path / "run", run.planned(other), 30.0)
    with pytest.raises(InputError, match="holds a run on other recordings, model or budget"):
        run.begin(tmp_path / "run", run.planned(machine), 60.0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--real", "nowhere"], "nowhere is no folder, expected one that holds recordings of one machine."),
        (
            ["--real", ".", "--over-graph"],
            "Found --over-graph with --real, where nothing is recorded. Leave it out.",
        ),
        (
            ["--budget", "3"],
            "Found --budget without --real, expected the folder of recordings that it is about.",
        ),
    ],
)
def test_bad_input_is_one_line_and_status_2(tmp_path, capsys, arguments, said):
    with pytest.raises(SystemExit) as ending:
        main(["prove", "--output", str(tmp_path / "run"), *arguments])
    assert ending.value.code == 2
    assert capsys.readouterr().err == f"pierburg: {said}\n"
    assert not (tmp_path / "run").exists()


def test_a_supply_voltage_that_is_withheld_is_no_effect(tmp_path, machine, asked, monkeypatch):
    first = machine.recordings["first"]
    wandering = Channel(TIME, 13.0 + np.sin(TIME))
    write(tmp_path / "bench" / "first.mcap", replace(first, supply_voltage=wandering))
    logged = machine_in(tmp_path / "bench", machine.described, read_recording)
    sag = {"id": "supply_sag", "parameters": {}}
    prove(tmp_path / "run", run.planned(logged, ["untouched"]))
    monkeypatch.setenv("ANSWER", json.dumps({"effects": [sag]}))
    plan = run.planned(logged, ["withheld_supply"])
    results = prove(tmp_path / "run", plan)
    # the second recording has no supply voltage that could be withheld
    assert [result["name"] for result in results] == [
        "first-untouched",
        "second-untouched",
        "first-withheld_supply-plain",
    ]
    assert results[2]["beside"] == ["supply_sag"] and not results[2]["named"]
    assert read_recording(tmp_path / "run/trials/first-withheld_supply-plain/recording.mcap").supply_voltage is None
    alarms = document.headline(document.Run(results, plan))["Logged supply voltage withheld: given another effect"]
    assert str(alarms).startswith("1/1")
