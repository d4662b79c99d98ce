"""docs/control.md says what the declaration of the settings says."""

from pathlib import Path

from pierburg_ros.control import SETTINGS

DOCUMENT = Path(__file__).parents[2] / "docs/control.md"


def test_the_table_of_settings_is_the_declaration():
    rows = [
        f"| `{each.name}` | {each.unit} | {each.default:g} | {each.minimum:g} to {each.maximum:g} | {each.meaning} |"
        for each in SETTINGS
    ]
    assert "\n".join(rows) in DOCUMENT.read_text(encoding="utf-8")
