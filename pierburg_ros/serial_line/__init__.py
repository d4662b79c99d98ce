"""An actuator at the end of a serial line: frames, their content, the line, and the device's clock. Knows no ROS."""
