"""Independent references that tests compare the simulator with; nothing here imports `pierburg_ros`."""
