"""How far ahead a model may be trusted, where its state is measured and where it is not."""

from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.report.horizons import HORIZONS, horizons

WARM = {"thermal_resistance.thermal_resistance": 30.0, "thermal_resistance.heat_capacity": 0.4}


def test_a_model_that_remembers_longer_than_a_stretch_is_judged_over_the_whole_alone():
    """After 3 s from a cold start the right model would look worse than one without heat."""
    data = data_on(recording(WARM, duration=30.0))
    found = horizons(data, [(NOMINAL, None), (NOMINAL, None), (NOMINAL.with_values(WARM), None)])
    *short, whole = found
    assert [each.after for each in found] == [*HORIZONS, None]
    assert all(each.final_rmse is None and each.nominal_rmse is not None for each in short)
    assert whole.final_rmse is not None and whole.final_rmse < 0.1 * whole.nominal_rmse
