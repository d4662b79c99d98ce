"""The textbook formulation as a whole: converged, steppable, in agreement with the practice recordings."""

import json
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.proof.excitation import duty_sequence
from pierburg_ros.proof.formulation import TextbookPlant, simulate_textbook
from pierburg_ros.proof.formulation.textbook import usual_step
from pierburg_ros.proof.formulation.values import CATALOGUE, OUTSIDE, textbook_values
from pierburg_ros.proof.strengths import strength
from pierburg_ros.recording import read_recording

PRACTICE = Path(__file__).parents[2] / ".." / "shared" / "practice"
CONVERTER = 5.0 / 4096.0 / np.sqrt(12.0)  # V, the practice logger's resolution as noise
PHASES = {"cogging_torque": 3.4468, "external_load": 0.0}  # rad, fitted once: the labels do not give them
RELAXATION = {
    "relaxation.stiffness": 0.06144,
    "relaxation.time_constant": 3.8936,
}  # fitted once to practice-20


# Rounding to a converter's step amplifies any difference to a whole step, so it is left out here.
@pytest.mark.parametrize("effect", [e for e in (*CATALOGUE, *OUTSIDE) if e != "sensor_quantization"])
def test_halving_the_step_changes_nothing_that_a_sensor_sees(effect):
    time = np.arange(10000) / 500.0
    random = np.random.default_rng(5)
    duty = duty_sequence(time, random, holdout=False)
    values = strength(effect, random)
    step = usual_step(textbook_values(values))
    coarse, fine = (simulate_textbook(values, time, duty, longest_step=h) for h in (step, step / 2))
    assert np.abs(coarse - fine).max() < 0.0002


def label_values(label):
    """Flat values of a practice label, with what it does not say."""
    values = dict(label["drifted"])
    for effect in label["effects"]:
        values.update({f"{effect['id']}.{name}": given["value"] for name, given in effect["parameters"].items()})
        if effect["id"] in PHASES:
            values[f"{effect['id']}.phase"] = PHASES[effect["id"]]
    return {**values, **RELAXATION} if label["not_in_catalogue"] == "relaxation" else values


@pytest.mark.parametrize("number", range(22))
@pytest.mark.parametrize("part", ["train", "holdout"])
def test_practice_recordings_are_explained_down_to_their_noise(number, part):
    folder = PRACTICE / f"practice-{number:02d}"
    if not folder.exists():
        pytest.skip("the practice recordings are not beside the project")
    label = json.loads((folder / "truth.json").read_text())
    recording = read_recording(folder / f"{part}.mcap")
    simulated = simulate_textbook(label_values(label), recording.command.time, recording.command.values, recording.time)
    rms = np.sqrt(np.mean((recording.measured - simulated) ** 2))
    assert rms <= 1.05 * np.hypot(label["noise_volts"], CONVERTER)


def test_stepping_gives_what_simulating_gives():
    time = np.arange(1500) / 500.0
    duty = duty_sequence(time, np.random.default_rng(2), holdout=False)
    values = {
        "input_delay.delay": 0.0051,
        "backlash.gap": 0.05,
        "thermal_resistance.thermal_resistance": 10.0,
    }
    values["thermal_resistance.heat_capacity"] = 0.5
    plant = TextbookPlant(values)
    stepped = []
    for each in duty:
        stepped.append(plant.measure())
        plant.advance(each, 0.002)
    assert np.abs(np.array(stepped) - simulate_textbook(values, time, duty)).max() < 1e-6


def test_new_values_keep_the_state():
    plant = TextbookPlant({})
    plant.advance(0.24, 0.5)
    before = plant.angle, plant.velocity, plant.time
    plant.values = {**plant.values, "armature_resistance": 5.0}
    assert (plant.angle, plant.velocity, plant.time) == before
    assert plant.values["armature_resistance"] == 5.0


def test_a_reset_starts_over_with_the_same_noise():
    plant = TextbookPlant({}, noise=0.003, seed=4)
    first = [plant.measure() for _ in range(5)]
    plant.advance(0.3, 0.2)
    plant.reset()
    assert [plant.measure() for _ in range(5)] == first
    assert np.std(first) > 0.0


def test_a_recorded_supply_is_followed():
    time = np.arange(500) / 500.0
    duty = np.full(time.size, 0.24)
    supplied = simulate_textbook({}, time, duty, supply_voltage=np.full(time.size, 12.0))
    assert np.array_equal(supplied, simulate_textbook({"supply_voltage": 12.0}, time, duty))


def test_an_unknown_value_is_refused():
    with pytest.raises(InputError, match=r"found value 'backlash.size'"):
        simulate_textbook({"backlash.size": 0.1}, [0.0, 1.0], [0.0, 0.0])


def test_heating_without_heat_capacity_is_refused():
    with pytest.raises(InputError, match="heat_capacity of 0 J/K"):
        TextbookPlant({"thermal_resistance.thermal_resistance": 5.0})
