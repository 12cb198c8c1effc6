"""Entry point of the laboratory's commands."""

from laboratory import commands
from supervision import cli


def main() -> int:
    """Run a command; return its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(commands.FOLDER)
