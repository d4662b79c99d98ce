"""Topics and services of each node, from the SROS2 policies, which are written from the graph that the nodes have."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from reference.markdown import code, table

POLICIES = Path(__file__).parents[2] / "sros2"
OF_EVERY_NODE = ("/rosout", "/parameter_events", "~/describe_parameters", "~/get_parameter_types", "~/get_parameters")
OF_EVERY_NODE += ("~/get_type_description", "~/list_parameters", "~/set_parameters", "~/set_parameters_atomically")


def page() -> str:
    """One row a node."""
    return table(("node", "publishes", "subscribes", "services"), map(_row, sorted(POLICIES.glob("*.policy.xml"))))


def _row(path: Path) -> tuple[str, str, str, str]:
    root = ElementTree.parse(path).getroot()
    names = (_names(root, f".//topics[@{way}='ALLOW']/topic") for way in ("publish", "subscribe"))
    return code(path.name.split(".")[0]), *names, _names(root, ".//services[@reply='ALLOW']/service")


def _names(root: ElementTree.Element, path: str) -> str:
    return ", ".join(code(found.text) for found in root.findall(path) if found.text not in OF_EVERY_NODE)
