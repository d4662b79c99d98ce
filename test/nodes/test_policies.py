"""The SROS2 policies in the repository against the nodes as they are on the graph."""

import importlib.util
from pathlib import Path
from xml.etree import ElementTree

import pytest

from pierburg_ros.nodes.core.policy import Rights, named, policy, rights

ROOT = Path(__file__).parent.parent.parent
FOLDER = ROOT / "sros2"
NODES = ("plant", "controller", "recorder", "monitor", "excitation", "serial_driver")


def test_a_policy_grants_what_it_was_made_from():
    granted = Rights(
        frozenset({"duty", "/rosout"}), frozenset({"~/set_parameter"}), frozenset(), frozenset({"a/split"})
    )
    assert rights(policy("controller", granted)) == granted


def test_names_of_a_node_are_its_own_relative_or_absolute():
    assert named(["/monitor/x", "/duty", "/diagnostics"], "monitor") == {"~/x", "duty", "/diagnostics"}


@pytest.mark.parametrize("node", NODES)
def test_a_policy_has_the_form_of_schema_0_2_0(node):
    root = ElementTree.parse(FOLDER / f"{node}.policy.xml").getroot()
    assert root.attrib == {"version": "0.2.0"}
    assert [child.tag for child in root] == ["enclaves"]
    (enclave,) = root.findall("enclaves/enclave")
    (profile,) = enclave.findall("profiles/profile")
    assert profile.attrib == {"ns": "/", "node": node}
    for group in profile:
        rights_given = {"topics": {"publish", "subscribe"}, "services": {"reply", "request"}}[group.tag]
        (right,) = group.attrib
        assert right in rights_given
        assert group.attrib[right] == "ALLOW"
        assert {item.tag for item in group} == {group.tag.removesuffix("s")}


@pytest.mark.parametrize("node", NODES)
def test_no_policy_allows_by_pattern(node):
    assert "*" not in (FOLDER / f"{node}.policy.xml").read_text()


@pytest.mark.ros
@pytest.mark.parametrize("node", NODES)
def test_a_policy_allows_exactly_what_the_node_has(node, tmp_path):
    pytest.importorskip("rclpy")
    spec = importlib.util.spec_from_file_location("write_policies", FOLDER / "write_policies.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    assert rights((FOLDER / f"{node}.policy.xml").read_text()) == script.observed(node, tmp_path)
