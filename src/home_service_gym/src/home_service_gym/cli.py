"""Entry point of the commands of the Gymnasium environments."""

from home_service import cli
from home_service_gym import commands


def main() -> int:
    """Run a command; return its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(folder=commands.FOLDER)
