"""`python -m pierburg_ros`: the `pierburg` command."""

from pierburg_ros.starting import command

command("pierburg")
