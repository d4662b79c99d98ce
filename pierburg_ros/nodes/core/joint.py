"""What the shaft's joint is called, in every node and picture of one actuator. Knows no ROS."""

SHAFT = "swirl_shaft"
"""Name of the joint outside any namespace."""
JOINT = f"name of the joint; empty: {SHAFT}, with the namespace and _ before it"
"""What the parameter of every node that names the joint means."""


def joint_name(chosen: str, namespace: str) -> str:
    """The `chosen` name, or that which follows from the namespace, so that two actuators differ on one robot."""
    return chosen or "_".join([*namespace.strip("/").split("/"), SHAFT]).lstrip("_")
