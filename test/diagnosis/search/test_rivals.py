"""What could stand for an effect by other means is fitted from where the effect fades."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
import pytest
from support.fits import made_up
from support.recordings import NOMINAL, data_on, recording, recording_in_closed_loop

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.search.rivals import fit_rivals
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.estimation.data import data_of, in_parts
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.explanation import AFTER, Explanation, Variant, quantities, without
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

VISCOUS = Variant("viscous_friction", ("coefficient",))
PLAY = Variant("backlash", ("gap", "motor_friction_share"))


def with_rivals(search: Search, best: Fit, drifts: tuple[str, ...]) -> Search:
    """The search with the rivals of `best` that drift; what is left of it without a quantity counts as grown."""
    search.drifts = drifts
    for quantity in quantities(best.explanation):
        search.expanded.add(without(best.explanation, quantity))
    fit_rivals(search, best)
    return search


@pytest.mark.parametrize(
    "pair",
    [
        ("armature_resistance", "torque_constant"),
        ("armature_resistance", "supply_voltage"),
        ("torque_constant", "supply_voltage"),
    ],
    ids="-".join,
)
def test_what_stands_for_viscous_friction_is_found_as_it_fades(pair: tuple[str, str], pool: Executor) -> None:
    """Viscous friction b at the shaft is (k_g k_m)^2 / R larger by b at the same k_g k_m V / R: an exact tie."""
    search = Search(data_on(recording({"viscous_friction.coefficient": 0.025})), NOMINAL, pool)
    best = search.add(Explanation((), (VISCOUS,)), {"viscous_friction.coefficient": 0.02})
    other = with_rivals(search, best, pair).fits[Explanation(pair)]
    assert other.chi2 == pytest.approx(best.chi2, rel=1e-3)
    value = other.values
    braking = (37.3 * value["torque_constant"]) ** 2 / value["armature_resistance"]
    push = 37.3 * value["torque_constant"] * value["supply_voltage"] / value["armature_resistance"]
    assert braking == pytest.approx((37.3 * 0.022) ** 2 / 4.139 + 0.025, rel=1e-3)
    assert push == pytest.approx(37.3 * 0.022 * 13.5 / 4.139, rel=1e-3)


def test_what_stands_for_viscous_friction_beside_play_is_found_as_it_fades(pool: Executor) -> None:
    truth = {"viscous_friction.coefficient": 0.025, "backlash.gap": 0.04, "backlash.motor_friction_share": 0.1}
    search = Search(data_on(recording(truth, duties=(-0.2, 0.36))), NOMINAL, pool)
    best = search.add(Explanation((), (PLAY, VISCOUS)), truth)
    pair = ("armature_resistance", "torque_constant")
    assert best.ratio < 1.03
    assert with_rivals(search, best, pair).fits[Explanation(pair, (PLAY,))].ratio < 1.03


def test_a_load_that_acts_throughout_is_a_preload(pool: Executor) -> None:
    """0.03 N.m that close, from the first sample to the last, are 0.03 N.m more preload."""
    search = Search(data_on(recording({"spring_preload": 0.32}, duration=12.0)), NOMINAL, pool)
    load = Variant("external_load", ("torque",), (("start", 0.0), ("end", 0.0)))
    best = search.add(Explanation((), (load,)), {"external_load.torque": 0.02})
    other = with_rivals(search, best, ("spring_preload",)).fits[Explanation(("spring_preload",))]
    assert best.values["external_load.torque"] == pytest.approx(0.03, rel=0.02)
    assert other.values["spring_preload"] == pytest.approx(0.29 + best.values["external_load.torque"], rel=1e-3)
    assert other.chi2 == pytest.approx(best.chi2, rel=1e-3)


def test_a_load_that_never_ends_is_a_preload_that_changed(pool: Executor) -> None:
    """A spring that is tightened by 0.03 N.m after 7 s pushes as a load of 0.03 N.m does that begins then."""
    tightened = NOMINAL.with_values({"spring_preload": 0.32})
    plain = recording({}, duration=14.0)
    hall = data_of([plain], NOMINAL).runs[0].simulated(NOMINAL, Switch(tightened, 7.0))
    noisy = hall + 0.003 * np.random.default_rng(3).standard_normal(hall.size)
    search = Search(data_on(replace(plain, measured=noisy)), NOMINAL, pool)
    load = Variant("external_load", ("torque", "start", "end"))
    truth = {"external_load.torque": 0.03, "external_load.start": 7.0, "external_load.end": 14.0}
    best = search.add(Explanation((), (load,)), truth)
    assert best.ratio < 1.05
    changed = with_rivals(search, best, ()).fits[Explanation(changed="spring_preload")]
    assert changed.chi2 == pytest.approx(best.chi2, rel=1e-3)
    assert changed.values["spring_preload" + AFTER] == pytest.approx(0.32, rel=0.01)
    assert search.preferred() is changed


def test_a_drift_has_no_rivals_but_what_may_be_added_without_it(pool: Executor) -> None:
    search = Search(data_on(recording({"spring_preload": 0.32}, duration=5.0)), NOMINAL, pool)
    best = search.add(Explanation(("spring_preload",)))
    with_rivals(search, best, ("spring_preload", "coulomb_friction"))
    assert set(search.fits) == {Explanation(("spring_preload",)), Explanation()}


@pytest.mark.parametrize(("without_any", "is_refined"), [(9.0, True), (1.15, False)], ids=["most", "little"])
def test_an_earlier_rival_is_refined_if_it_explains_most_of_what_the_best_does(
    without_any: float, is_refined: bool, pool: Executor, monkeypatch: pytest.MonkeyPatch
) -> None:
    search, refined = Search(data_on(recording({}, duration=5.0)), NOMINAL, pool), []
    monkeypatch.setattr(search, "refine_alone", lambda fit: refined.append(fit.explanation))
    best, play = Explanation((), (VISCOUS,)), Explanation((), (PLAY,))
    for explanation, ratio in ((Explanation(), without_any), (best, 1.0), (play, 1.1)):
        search.keep(made_up(explanation, ratio, NOMINAL))
    with_rivals(search, search.fits[best], ())
    assert refined == [play] * is_refined


def test_another_drift_beside_what_jumps_starts_from_the_best_values(pool: Executor) -> None:
    """Grown on stiction alone, whose values stand for the drift by then, it would stop at 100 times the noise."""
    truth = {
        "spring_preload": 0.285,
        "static_friction.breakaway_torque": 0.27,
        "static_friction.stribeck_velocity": 0.1,
    }
    stiction = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
    search = Search(data_on(recording_in_closed_loop(truth, seed=1)), NOMINAL, pool)
    best = search.add(Explanation(("spring_stiffness",), (stiction,)), truth)
    assert best.ratio > 10.0
    other = with_rivals(search, best, ("spring_stiffness", "spring_preload")).fits
    assert other[Explanation(("spring_preload",), (stiction,))].ratio < 1.5


def test_a_load_on_what_has_no_spring_is_no_preload(pool: Executor) -> None:
    """A pendulum, steps of torque for 8 s, and from 4 s on something that pushes with 0.1 N.m."""
    pendulum = Model.nominal(read_actuator("ak80"))
    truth = {"external_load.torque": 0.1, "external_load.start": 4.0, "external_load.end": 8.0}
    random = np.random.default_rng(5)
    time = np.arange(0.0, 8.0, 0.004)
    torque = random.uniform(-0.6, 0.6, 10)[(time / 0.8).astype(int)]
    angle = simulate(pendulum.with_values(truth), Inputs(time, torque), time)
    noisy = angle + 0.001 * random.standard_normal(time.size)
    pushed = Recording("pushed.csv", "position", time, noisy, Channel(time, torque), input="torque")
    search = Search(in_parts(data_of([pushed], pendulum)), pendulum, pool)
    load = Variant("external_load", ("torque", "start", "end"))
    best = search.add(Explanation((), (load,)), truth)
    assert best.ratio < 1.05
    rivals = with_rivals(search, best, ("coulomb_friction",)).fits
    assert not any(rival.changed for rival in rivals)
