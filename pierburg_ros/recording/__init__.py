"""Measured data: recordings read from MCAP, rosbag2 and CSV, and written to MCAP; needs no ROS."""

from pierburg_ros.recording.read import read_recording
from pierburg_ros.recording.recording import Channel, Recording
from pierburg_ros.recording.write import write_recording, write_simulated

__all__ = ["Channel", "Recording", "read_recording", "write_recording", "write_simulated"]
