"""Where controller and plant meet without ROS: simulate the loop, judge it, tune it."""

from pierburg_ros.closed_loop.loop import Run, simulate_loop, simulate_runs

__all__ = ["Run", "simulate_loop", "simulate_runs"]
