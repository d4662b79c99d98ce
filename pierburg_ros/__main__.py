"""`python -m pierburg_ros`: the `pierburg` command."""

from pierburg_ros.cli.app import main

main()
