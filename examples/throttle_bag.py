"""Writes the bag `throttle`, which stands for one of your own: `python throttle_bag.py`.

An electronic throttle (my_actuator.yaml), simulated with what its description does not say. The bag has foreign topics
and units: /throttle/pwm is a Float32 in percent, /throttle/adc counts of a 12 bit converter over 5 V.
"""

from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

import pierburg_ros as pr

RATE, DURATION, NOISE = 200.0, 20.0, 0.003  # Hz, s, V
COUNT = 5.0 / 4096  # V
CONCEALED = {"input_delay.delay": 0.02, "coulomb_friction": 0.115}  # s, N.m; the description says 0 and 0.1
ROS = get_typestore(Stores.ROS2_JAZZY)


def signals() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time [s], duty [1] and Hall voltage [V] of the throttle, each of shape (samples,)."""
    random = np.random.default_rng(5)
    time = np.arange(0.0, DURATION, 1.0 / RATE)
    levels = random.uniform(0.0, 0.22, 60)
    held = np.repeat(levels, random.integers(30, 180, levels.size))[: time.size]
    duty = np.where(time < 0.5, 0.0, np.round(held, 3))
    model = pr.Model.nominal(Path(__file__).with_name("my_actuator.yaml")).with_values(CONCEALED)
    return time, duty, pr.simulate(model, duty=duty, time=time, noise=NOISE, seed=5).measured


def write(folder: Path) -> None:
    """Write the bag; `folder` must not exist."""
    kinds = {"/throttle/pwm": "std_msgs/msg/Float32", "/throttle/adc": "std_msgs/msg/UInt16"}
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topics = {topic: writer.add_connection(topic, kind, typestore=ROS) for topic, kind in kinds.items()}
        for time, duty, voltage in zip(*signals(), strict=True):
            for topic, value in (("/throttle/adc", round(voltage / COUNT)), ("/throttle/pwm", 100.0 * duty)):
                message = ROS.types[kinds[topic]](value)
                writer.write(topics[topic], round(1e9 * (1.0 + time)), ROS.serialize_cdr(message, kinds[topic]))


if __name__ == "__main__":
    write(Path("throttle"))
