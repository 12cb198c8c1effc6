"""The way in: that of all commands, to those of the environments."""

from home_service import cli
from home_service_gym import commands


def main() -> int:
    """Returns the exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(folder=commands.FOLDER)
