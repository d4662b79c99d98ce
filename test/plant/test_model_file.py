"""Model files: written, read back, and refused with the line that is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model, read_model

NOMINAL = Model.nominal(read_actuator("pierburg"))
EXAMPLE = """\
actuator: pierburg
parameters: {armature_resistance: 4.71, coulomb_friction: 0.2007}
effects:
  static_friction: {breakaway_torque: 0.27, stribeck_velocity: 0.1}
residual_torque: {angle: [0.0, 1.0], velocity: [0.0], torque: [[0.01], [0.02]]}
"""


def read(folder: Path, text: str) -> Model:
    path = folder / "model.yaml"
    path.write_text(text, encoding="utf-8")
    return read_model(path)


def test_file_of_the_contract_is_read(tmp_path: Path) -> None:
    model = read(tmp_path, EXAMPLE)
    assert model.values["armature_resistance"] == 4.71
    assert model.values["static_friction.stribeck_velocity"] == 0.1
    assert model.active_effects == ("static_friction",)
    assert model.residual_torque is not None and model.residual_torque["torque"] == [[0.01], [0.02]]


@pytest.mark.parametrize("actuator", ("pierburg", "xl330"))
def test_written_model_reads_back_the_same(tmp_path: Path, actuator: str) -> None:
    model = Model.nominal(read_actuator(actuator)).with_values(
        {"coulomb_friction": 0.05, "viscous_friction.coefficient": 0.02, "input_delay.delay": 0.01}
    )
    model.write(tmp_path / "model.yaml")
    assert read_model(tmp_path / "model.yaml") == model


def test_effect_of_the_nominal_description_can_be_taken_out(tmp_path: Path) -> None:
    model = Model.nominal(read_actuator("xl330")).with_values({"viscous_friction.coefficient": 0.0})
    model.write(tmp_path / "model.yaml")
    assert read_model(tmp_path / "model.yaml").active_effects == ()


def test_mapping_is_read_like_a_file() -> None:
    assert read_model(NOMINAL.as_mapping()) == NOMINAL


@pytest.mark.parametrize(
    ("old", "new", "message"),
    (
        ("armature_resistance", "resistance", "model.yaml line 2: There is no parameter resistance"),
        ("4.71", "-4.71", "model.yaml line 2: armature_resistance is -4.71; expected 0.1 to 50"),
        ("4.71", "lots", "model.yaml line 2: armature_resistance is 'lots'; expected a number"),
        ("static_friction:", "stiction:", "model.yaml line 4: unknown effect stiction"),
        ("stribeck_velocity", "velocity", "model.yaml line 4: static_friction has no parameter velocity"),
        ("0.27", "-9", "model.yaml line 4: static_friction.breakaway_torque is -9; expected 0 to 1e+09"),
        ("0.27", "0.1", "at least coulomb_friction"),
        ("{breakaway_torque: 0.27, stribeck_velocity: 0.1}", "0.27", "model.yaml line 4: static_friction is 0.27"),
        ("residual_torque:", "residual:", "model.yaml line 5: unknown residual"),
        ("actuator: pierburg", "actuator: nobody", "There is no actuator nobody"),
        ("actuator: pierburg\n", "", "names no actuator"),
        ("{armature", "[armature", "is not YAML"),
        ("torque: [[0.01], [0.02]]", "torque: [[0.01]]", "residual_torque.torque has shape (1, 1)"),
    ),
)
def test_refusal_names_the_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        read(tmp_path, EXAMPLE.replace(old, new, 1))
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_missing_value_is_asked_for(tmp_path: Path) -> None:
    text = "actuator: pierburg\neffects:\n  position_dependent_friction: {amplitude: 0.05, center: 1.0}\n"
    with pytest.raises(InputError, match=r"line 3: position_dependent_friction lacks width \[rad\]"):
        read(tmp_path, text)


def test_missing_file_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"does not exist, expected a model file"):
        read_model(tmp_path / "none.yaml")


def own_actuator(folder: Path) -> Path:
    path = folder / "my_throttle.yaml"
    path.write_text((Path(__file__).parents[2] / "examples/my_actuator.yaml").read_text(encoding="utf-8"))
    return path


def test_a_model_of_ones_own_actuator_carries_it(tmp_path: Path) -> None:
    description = own_actuator(tmp_path)
    model = Model.nominal(read_actuator(description)).with_values({"armature_resistance": 1.7})
    model.write(tmp_path / "model.yaml")
    description.unlink()
    again = read_model(tmp_path / "model.yaml")
    assert again == model
    again.write(tmp_path / "again.yaml")
    assert (tmp_path / "again.yaml").read_text() == (tmp_path / "model.yaml").read_text()


def test_a_model_may_name_the_description_beside_it(tmp_path: Path) -> None:
    own_actuator(tmp_path)
    model = read(tmp_path, "actuator: my_throttle.yaml\nparameters: {armature_resistance: 1.7}\n")
    assert model.actuator.name == "my_throttle" and model.values["armature_resistance"] == 1.7
    (tmp_path / "my_throttle.yaml").unlink()
    with pytest.raises(InputError, match=r"model.yaml line 1: There is no actuator my_throttle.yaml") as gone:
        read(tmp_path, "actuator: my_throttle.yaml\n")
    assert "\n" not in str(gone.value)


def test_a_damaged_description_in_a_model_is_refused_with_its_line(tmp_path: Path) -> None:
    model = Model.nominal(read_actuator(own_actuator(tmp_path)))
    model.write(tmp_path / "model.yaml")
    damaged = (tmp_path / "model.yaml").read_text().replace("load: spring", "load: feather")
    with pytest.raises(InputError, match="line 2: actuator: load: Input should be"):
        read(tmp_path, damaged)
