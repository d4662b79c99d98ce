"""What a terminal shows of texts that come from files: themselves."""

from rich.panel import Panel
from rich.table import Table

from pierburg_ros.cli.console.terminal import terminal


def test_markup_emoji_and_control_characters_are_shown_as_they_stand(capsys):
    table = Table("[bold]name", title=":smile: [red]x")
    table.add_row("\x1b]0;gone\x07[/red]")
    terminal().print(table, "[link=x]a[/link] \x1b[2J", Panel("[blink]"))
    shown = capsys.readouterr().out
    for text in ("[bold]name", ":smile: [red]x", r"\x1b]0;gone\x07[/red]", r"[link=x]a[/link] \x1b[2J", "[blink]"):
        assert text in shown
