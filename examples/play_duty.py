"""Plays the duty of a recording to a running plant, as `ros2 bag play` would: python play_duty.py FILE.

The Hall voltage that was recorded goes out beside it as `recorded_hall_voltage`, for comparison with the plant's.
"""

import sys
import time
from pathlib import Path

import rclpy
from rosbags.highlevel import AnyReader
from std_msgs.msg import Float64

NAMES = {"/duty": "duty", "/hall_voltage": "recorded_hall_voltage"}


def play(path: Path) -> None:
    """Publish the messages of a recording at the intervals at which they were recorded."""
    node = rclpy.create_node("player")
    publishers = {topic: node.create_publisher(Float64, name, 10) for topic, name in NAMES.items()}
    while publishers["/duty"].get_subscription_count() == 0:
        time.sleep(0.05)
    with AnyReader([path]) as reader:
        connections = [connection for connection in reader.connections if connection.topic in NAMES]
        start, first = time.monotonic(), reader.start_time
        for connection, recorded, data in reader.messages(connections):
            time.sleep(max(0.0, start + (recorded - first) * 1e-9 - time.monotonic()))
            value = reader.deserialize(data, connection.msgtype).data
            publishers[connection.topic].publish(Float64(data=value))


if __name__ == "__main__":
    rclpy.init()
    play(Path(sys.argv[1]))
    rclpy.shutdown()
