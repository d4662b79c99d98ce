"""The node that docs/extending/node.md adds, added to a copy of the package and run there."""

import re
import sys
from pathlib import Path

import pytest
from support.package_copy import blocks, copied, printed

TAKES = """
import json, sys
from pierburg_ros.nodes.core.travel import Travel
travel = Travel()
totals = [travel.take(value, 0.1) for value in (1.0, 1.05, 1.5, 1.45, 1.2)]
print(json.dumps([totals, "rclpy" in sys.modules]))
"""


@pytest.fixture
def with_node(tmp_path: Path) -> Path:
    """A copy of the package with the node of the page."""
    root = tmp_path / "copy"
    package = copied(root)
    core, shell = blocks("node.md")
    (package / "nodes/core/travel.py").write_text(core)
    (package / "nodes/travel.py").write_text(shell)
    starting = package / "starting.py"
    text, places = re.subn(
        r"^NODES = \(([^)]*[^,\s]),?\s*\)$", r'NODES = (\1, "travel")', starting.read_text(), flags=re.MULTILINE
    )
    assert places == 1
    starting.write_text(text)
    return root


def test_the_core_of_the_page_counts_without_ros(with_node: Path) -> None:
    totals, ros = printed(with_node, TAKES)
    assert totals == pytest.approx([0.0, 0.0, 0.5, 0.5, 0.8])
    assert not ros


@pytest.mark.ros
def test_the_node_of_the_page_publishes_the_total_and_refuses_what_is_out_of_range(with_node: Path, graph) -> None:
    from std_msgs.msg import Float64

    graph.environment["PYTHONPATH"] = str(with_node)
    totals = graph.watch("travel/total", Float64)
    code = "from pierburg_ros.cli.app import main; main()"
    process = graph.run([sys.executable, "-c", code, "run", "travel"])
    graph.until_connected()
    for count, value in enumerate((1.0, 1.5, 1.2), start=1):
        graph.publish("hall_voltage", Float64(data=value))
        graph.until(lambda count=count: len(totals) >= count, f"total {count}")
    assert [total.data for total in totals] == pytest.approx([0.0, 0.5, 0.8])
    (refused,) = graph.set("travel", dead_zone=2.0)
    assert not refused.successful and "expected 0 to 1 V" in refused.reason
    assert graph.ended(process)[0] == 0
