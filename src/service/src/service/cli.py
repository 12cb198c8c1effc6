"""Entry point of the service's commands."""

from evaluation.options import GraphOptions
from evaluation.preload import preload_nodes
from service import commands
from supervision import cli
from supervision.command import Command


def main() -> int:
    """Run a command; return its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    return cli.main(commands.FOLDER, None, _prepare)


def _prepare(command: Command) -> None:
    if isinstance(command, GraphOptions):
        preload_nodes()
