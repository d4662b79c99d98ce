"""Windows: within the contract's limits, and as good as trying every choice."""

import itertools

import numpy as np
import pytest

from pierburg_ros.diagnosis.location.windows import windows
from pierburg_ros.proof.windows import share_of_best

TIME = 0.002 * np.arange(30000)


def bursts(number: int, seed: int) -> np.ndarray:
    """An effect that comes in `number` bursts of 0.3 s."""
    random = np.random.default_rng(seed)
    centres, sizes = random.uniform(0.0, 60.0, number), random.exponential(size=number)
    return sum(size * np.exp(-(((TIME - centre) / 0.15) ** 2)) for centre, size in zip(centres, sizes, strict=True))


@pytest.mark.parametrize("number", [1, 8, 30, 90])
def test_keep_the_limits_of_the_contract(number):
    found = windows(TIME, bursts(number, number) ** 2)
    assert 1 <= len(found) <= 20
    assert all(end - start >= 0.2 for start, end in found)
    assert sum(end - start for start, end in found) <= 15.0
    assert all(start >= 0.0 and end <= TIME[-1] + 1e-9 for start, end in found)


@pytest.mark.parametrize("number", [1, 8, 30, 90])
def test_hold_most_of_what_windows_of_that_length_could(number):
    effect = bursts(number, number)
    found = [{"start": start, "end": end} for start, end in windows(TIME, effect**2)]
    assert share_of_best(TIME, effect, found) > 0.9


def test_do_not_overlap_and_are_ranked():
    energy = bursts(12, 3) ** 2
    found = windows(TIME, energy)
    held = [energy[(start <= TIME) & (end > TIME)].sum() for start, end in found]
    assert held == sorted(held, reverse=True)
    ordered = sorted(found)
    assert all(before[1] <= after[0] for before, after in itertools.pairwise(ordered))


def test_are_the_best_there_are():
    """Against every choice of at most 2 windows of at least 2 bins within 5 of 20 bins."""
    random = np.random.default_rng(5)
    time = 0.005 * np.arange(401)
    for _ in range(20):
        place = np.minimum((time / 0.1).astype(int), 19)
        energy = (random.exponential(size=20) ** 2)[place]
        bins = np.bincount(place, weights=energy)
        found = windows(time, energy, most=2)
        length = round(sum(end - start for start, end in found) / 0.1)
        assert sum(bins[round(a / 0.1) : round(b / 0.1)].sum() for a, b in found) == pytest.approx(best(bins, length))


def best(bins: np.ndarray, length: int) -> float:
    """Most that one or two windows of at least 2 bins and together at most `length` bins hold."""
    spans = [(a, b) for a in range(bins.size) for b in range(a + 2, bins.size + 1) if b - a <= length]
    single = [bins[a:b].sum() for a, b in spans]
    double = [
        bins[a:b].sum() + bins[c:d].sum()
        for (a, b), (c, d) in itertools.combinations(spans, 2)
        if b <= c and b - a + d - c <= length
    ]
    return float(max([*single, *double]))


def test_nothing_to_hold_gives_none():
    assert windows(TIME, np.zeros(TIME.size)) == []
    assert windows(TIME[:20], np.ones(20)) == []


def test_an_uneven_clock_counts_energy_where_it_is():
    time = np.sort(np.random.default_rng(1).uniform(0.0, 20.0, 3000))
    found = windows(time, np.where((time > 7.0) & (time < 7.4), 1.0, 1e-6))
    assert found[0][0] == pytest.approx(7.0, abs=0.11) and found[0][1] == pytest.approx(7.4, abs=0.11)
