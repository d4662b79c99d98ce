"""Protects the actuator from a sensor that lies, a shaft that is blocked and a winding that gets hot. Knows no ROS."""
