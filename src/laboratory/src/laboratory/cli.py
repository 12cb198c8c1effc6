"""Entry point of the laboratory's commands."""

from home_service import cli
from laboratory import commands


def main() -> int:
    """Run a command; return its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(folder=commands.FOLDER)
