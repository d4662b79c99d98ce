"""Signal maps: which topic and field, or which column, a signal comes from, and in which unit."""

from pierburg_ros.recording.signal_map.map_file import Given, read_signal_map, signal_map
from pierburg_ros.recording.signal_map.source import SignalMap, Source, TimeSource

__all__ = ["Given", "SignalMap", "Source", "TimeSource", "read_signal_map", "signal_map"]
