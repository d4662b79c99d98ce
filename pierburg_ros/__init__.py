"""The Pierburg mechatronic actuator: simulated, controlled, recorded, diagnosed."""
