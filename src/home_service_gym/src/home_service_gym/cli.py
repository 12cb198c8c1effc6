"""Entry point of the commands of the Gymnasium environments."""

from home_service_gym import commands
from supervision import cli


def main() -> int:
    """Run a command; return its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(commands.FOLDER)
