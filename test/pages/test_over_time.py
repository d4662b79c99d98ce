"""Plots over time, and the room their signals take."""

import numpy as np
import pytest

from pierburg_ros.pages.over_time import BUCKETS, thinned
from pierburg_ros.pages.page import inert, stored
from pierburg_ros.pages.room import SIGNAL_ROOM, page_signals

TIME = 0.002 * np.arange(30000)


def test_thinning_loses_no_peak():
    values = np.zeros(TIME.size)
    values[12345], values[12346] = 5.0, -7.0
    time, kept = thinned(TIME, values)
    assert time.size <= 2 * BUCKETS + 2 and np.all(np.diff(time) > 0.0)
    assert kept.max() == 5.0 and kept.min() == -7.0
    assert time[np.argmax(kept)] == TIME[12345]


@pytest.mark.parametrize("minutes", [1, 20])
def test_signals_fit_into_a_page_with_their_peaks(minutes):
    time = 0.002 * np.arange(30000 * minutes)
    measured = np.sin(time)
    measured[777] = 9.0
    others = {f"other-{n}": np.zeros(time.size) for n in range(8)}
    signals = page_signals([{"time": time, "measured": measured, **others}], ("measured",))
    assert sum(len(stored(values, name == "0/time")["data"]) for name, values in signals.items()) <= SIGNAL_ROOM
    assert signals["0/measured"].max() == 9.0
    assert (signals["0/time"].size == time.size) == (minutes == 1)


def test_stored_signals_are_exact_to_a_part_in_sixty_thousand():
    import base64

    values = np.array([0.0, 1.0, -4.52, 0.0003, np.nan])
    kept = stored(values, exact=False)
    back = kept["scale"] * np.frombuffer(base64.b64decode(kept["data"]), "<i2")
    np.testing.assert_allclose(back, np.nan_to_num(values), atol=4.52 / 65534 * 1.001)


def test_json_in_a_page_is_no_markup():
    assert inert({"name": "</script><b>&"}) == '{"name":"\\u003c/script\\u003e\\u003cb\\u003e\\u0026"}'
