"""Model, actuator, settings and schedule files that once ended in a traceback, each the smallest that showed it."""

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.control import read_duty_file, read_parameter_file, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.plant.model_file import read_model
from pierburg_ros.recording import read_recording

MODEL = "actuator: pierburg\nparameters: {armature_resistance: %s}\n"
RESIDUAL = "actuator: pierburg\nresidual_torque: %s\n"
BUMP = "{position_dependent_friction: {amplitude: 0.1}}"
CSV = "time,duty,hall_voltage\n0,0,0\n1,0,%s\n"


@pytest.fixture
def actuator():
    from importlib import resources

    return (resources.files("pierburg_ros.actuators") / "pierburg.yaml").read_text()


def refusal(tmp_path, read, text, name="input.yaml") -> str:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as refused:
        read(path)
    assert len(str(refused.value)) <= 290
    return str(refused.value)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (MODEL % ("9" * 400), "armature_resistance is inf; expected 0.1 to 50"),
        (MODEL % "2001-01-01", "armature_resistance is '2001-01-01'; expected a number"),
        (MODEL % "2001-99-99", "expected a number"),
        (MODEL % "1:2:3:4:5:6", "expected a number"),
        (MODEL % "[[[[[[[[[[[[[[[[[[[[[[[", "deeply nested lists"),
        (MODEL % ("'" + "x" * 70_000 + "'"), "a value of 70000 characters"),
        ("actuator: [pierburg]", "expected a name like `pierburg`, a path or a description"),
        ("actuator: {a: b}", "actuator: name: Field required"),
        ("actuator: 7", "actuator is 7; expected a name"),
        ("actuator: " + "a" * 5000, "File name too long"),
        ("actuator: /dev/zero", "/dev/zero is a device"),
        ("actuator: pierburg\nparameters: {1: 2}", "There is no parameter 1"),
        (RESIDUAL % "7", "residual_torque is 7"),
        (RESIDUAL % "{angle: a, velocity: [0.0], torque: [[0]]}", "residual_torque.angle is not made of numbers"),
        (RESIDUAL % "{angle: [0], velocity: [0, 1], torque: [[0, 1], [2]]}", "residual_torque.torque is not made"),
        (RESIDUAL % "{angle: [0], velocity: [0], torque: [[1e300]]}", "expected magnitudes up to 1e+09"),
        (RESIDUAL % "{angle: [0], velocity: [0], torque: [[true]]}", "is not made of numbers"),
        ("actuator: pierburg\nparameters: {hall_voltage_open: 0.42}", "are both 0.42; expected two voltages"),
    ],
)
def test_models(tmp_path, text, reason):
    assert reason in refusal(tmp_path, read_model, text)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (
            "nominal: 4.139",
            "nominal: '4.139'",
            "armature_resistance.nominal: Input should be a valid number",
        ),
        ("nominal: 4.139", "nominal: true", "Input should be a valid number"),
        ("nominal: 4.139", "nominal: .nan", "Input should be a finite number"),
        ("minimum: 0.1,", "minimum: -0.1,", "armature_resistance may be -0.1; expected a minimum above 0"),
        ("nominal: 2.4602e-6, minimum: 1.0e-8", "nominal: 0.0, minimum: 0.0", "total_inertia may be 0; expected"),
        ("nominal: 0.2007, minimum: 0.0", "nominal: 0.2, minimum: -1.0", "coulomb_friction may be -1; expected"),
        ("maximum: 50.0", "maximum: 1.0e300", "armature_resistance may exceed 1e+09"),
        ("name: pierburg", "name: " + "a" * 100, "at most 80 characters"),
        ("name: pierburg", "name: 2001-01-01\nname: b", "name given twice"),
        ("stops: {lower: 0.0", "stops: {lower: 9.0", "stops.lower must be less than stops.upper"),
        ("load: spring", "load: spring\neffects: {backlash: {gap: -1.0}}", "backlash.gap is -1; expected 0 to 1e+09"),
        ("load: spring", "load: spring\neffects: " + BUMP, "position_dependent_friction lacks center [rad]"),
    ],
)
def test_actuators(tmp_path, actuator, old, new, reason):
    assert old in actuator
    assert reason in refusal(tmp_path, read_actuator, actuator.replace(old, new, 1))


def test_equal_hall_ends_of_an_actuator_are_refused_where_it_is_simulated(tmp_path, actuator):
    from pierburg_ros.plant import Model

    text = actuator.replace("nominal: 4.52", "nominal: 0.42")
    with pytest.raises(InputError, match=r"are both 0\.42"):
        Model.nominal(read_actuator(_written(tmp_path, text)))


def _written(folder, text):
    path = folder / "actuator.yaml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("value", ["9" * 400, "2001-01-01", "[1]", "true", "'1'", ".nan"])
def test_settings(tmp_path, value):
    text = f"controller: {{ros__parameters: {{zero: {value}}}}}"
    assert "zero is " in refusal(tmp_path, read_parameter_file, text)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("time,duty\n0," + "1" * 70_000, "has a line of more than 65536 characters"),
        ('time,duty\n0,"' + "1\n" * 200_000, "field larger than field limit"),
        ("time,duty\n1e300,0\n", "expected magnitudes up to 1e+09"),
        ("time,duty\n0,1e400\n", "Duty inf is not within -1 to 1"),
        ("time,duty\n0,\x00\n", "line 2"),
    ],
)
def test_schedules(tmp_path, text, reason):
    assert reason in refusal(tmp_path, read_duty_file, text)
    assert refusal(tmp_path, read_setpoint_file, text)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (CSV % "1e300", "expected magnitudes up to 1e+09"),
        (CSV % "1e400", "has '1e400' as hall_voltage in row 3, expected a finite number"),
        (CSV % ("9" * 70_000), "has a line of more than 65536 characters"),
        (CSV % "\x1b[2J", r"has '\x1b[2J' as hall_voltage"),
        (CSV.replace("\n1,", "\n1e300,") % 0, "spans 1e+300 s with 2 samples, expected at most 120 s"),
        (CSV.replace("\n1,", "\n1e6,") % 0, "spans 1e+06 s with 2 samples, expected at most 120 s"),
        ("a" * 5000 + ",b\n1,2\n", "no time column"),
        ("\x1b[2J,duty\n1,2\n", r"found: \x1b[2J, duty"),
    ],
)
def test_tables(tmp_path, text, reason):
    assert reason in refusal(tmp_path, read_recording, text, "run.csv")
