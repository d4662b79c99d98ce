"""Each kind of dirt does what it says and nothing else, and a dirty run is planned, recorded and counted."""

import json
from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.proof import document
from pierburg_ros.proof.bench import record
from pierburg_ros.proof.concealment import DIRTY, draw_dirty
from pierburg_ros.proof.dirt.kinds import DIRT, DISTURBING, SPOILING
from pierburg_ros.proof.dirt.log import Log, Messages
from pierburg_ros.proof.plan import planned
from pierburg_ros.proof.score import harmed, said
from pierburg_ros.recording import read_recording

TIME = np.arange(15000) / 500.0
HALL = 2.5 + 1.5 * np.sin(TIME) + 0.002 * np.random.default_rng(0).standard_normal(TIME.size)
LOG = Log(Messages.of(TIME, HALL), Messages.of(TIME, np.round(0.2 + 0.1 * np.sin(TIME), 4)))


def spoiled(kind):
    return SPOILING[kind](LOG, np.random.default_rng(1))


def changed(kind):
    """What a kind adds to the Hall voltage [V]."""
    return spoiled(kind).hall.values - HALL


@pytest.mark.parametrize("kind", ["spikes", "hum", "sensor_drift", "clipping"])
def test_a_spoiled_sensor_leaves_the_duty_alone(kind):
    assert spoiled(kind).duty is LOG.duty and np.array_equal(spoiled(kind).hall.time, TIME)


def test_what_sensors_suffer():
    assert np.mean(changed("spikes") != 0.0) == pytest.approx(0.01, abs=0.003)
    assert np.std(changed("hum")) == pytest.approx(0.01 / np.sqrt(2.0), rel=0.01)
    assert np.ptp(changed("sensor_drift")) == pytest.approx(0.05)
    assert np.max(np.abs(np.diff(changed("sensor_drift")))) < 1e-4
    assert np.all(changed("clipping") <= 0.0) and np.mean(changed("clipping") < 0.0) > 0.05


def test_what_messages_suffer():
    lost, rows = spoiled("lost_messages"), spoiled("lost_rows")
    assert lost.duty.time.size == pytest.approx(0.9 * TIME.size, rel=0.02)
    assert np.array_equal(lost.duty.number, np.round(500.0 * lost.duty.time))
    assert np.array_equal(rows.hall.time, rows.duty.time) and not np.any(rows.hall.number)
    assert np.std(spoiled("jitter").hall.time - TIME) == pytest.approx(0.0002, rel=0.1)
    assert np.max(np.abs(spoiled("coarse_duty").duty.values - LOG.duty.values)) <= 0.005 + 1e-9
    assert np.allclose(spoiled("late_duty").duty.time - TIME, 0.02)
    assert spoiled("fast_clock").duty.time[-1] == pytest.approx(1.002 * TIME[-1])
    begun = spoiled("begins_in_motion").hall
    assert begun.time[0] == pytest.approx(0.0, abs=0.002) and abs(begun.values[50] - begun.values[0]) > 0.1


def test_what_acts_on_the_valve():
    supply, hand, bridge = (DISTURBING[kind](TIME, np.random.default_rng(1)) for kind in DISTURBING)
    assert (supply.supply.min(), supply.supply.max()) == pytest.approx((12.0, 14.5))
    assert np.count_nonzero(hand.torque) / 500.0 == pytest.approx(5.0, abs=0.1)
    assert np.min(hand.torque) < -0.05 and np.max(hand.torque) > 0.05
    assert np.count_nonzero(~bridge.enabled) / 500.0 == pytest.approx(5.0, abs=0.1)


@pytest.mark.parametrize("kind", ["open_bridge", "lost_messages"])
def test_a_dirty_recording_is_that_of_the_clean_trial_but_for_its_dirt(tmp_path, kind):
    dirty = replace(draw_dirty(kind, 0, 3), duration=6.0)
    clean = record(replace(dirty, dirt=""))
    record(dirty).write(tmp_path / "run.mcap")
    found = read_recording(tmp_path / "run.mcap")
    assert np.array_equal(found.command.at(found.time)[:100], clean.duty[np.searchsorted(clean.time, found.time)][:100])
    assert (kind == "lost_messages") == bool(found.losses)


def test_half_of_the_trials_hide_nothing():
    for kind in DIRT:
        clean, hidden = draw_dirty(kind, 0, 5), draw_dirty(kind, 1, 5)
        assert clean.verdict == "consistent" and hidden.effect_ids == ("static_friction",)
        assert (clean.kind, clean.dirt, clean.closed_loop) == (kind, kind, False)
    assert planned(1, 2, dirty=True).size == 2 * len(DIRTY)
    with pytest.raises(InputError, match="Leave one option out"):
        planned(1, over_graph=True, dirty=True)


TRUTH = {"drifted": {"armature_resistance": 5.0}, "changes": [], "effects": [{"id": "sensor_lag"}]}


def test_harm_is_a_name_that_is_not_there():
    drifted = {name: {"drifted": name == "armature_resistance"} for name in ("armature_resistance", "supply_voltage")}
    right = {"effects": [{"id": "sensor_lag"}], "parameters": drifted}
    assert not harmed(TRUTH, right) and not harmed(TRUTH, {"effects": []})
    assert harmed(TRUTH, {**right, "effects": [{"id": "backlash"}]})
    assert harmed({**TRUTH, "drifted": {}}, right)


def test_dirt_is_said_where_the_document_speaks_of_it():
    assert not said({"excluded": [], "data_quality": {"dirt": []}})
    assert said({"excluded": [{"start": 1.0}]}) and said({"data_quality": {"dirt": ["hum"]}})


def test_a_dirty_run_is_counted_by_its_dirt(tmp_path):
    plan = planned(1, 1, ["hum"], dirty=True)
    result = {"kind": "hum", "right": True, "said": True, "harmed": False, "seconds": 1.0}
    text = document.markdown(document.Run([result], plan))
    assert "| hum | 1 | 1 | 1 | 0 | 0 |" in text
    assert json.dumps(result)
