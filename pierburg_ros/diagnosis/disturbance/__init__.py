"""Disturbances of a recording that are not physics of the actuator, tested where every explanation leaves a
remainder."""
