"""Entry point of the commands behind the scripts."""

from typing import List, Optional

from evaluation.options import GraphOptions
from evaluation.preload import preload_nodes
from home_service import commands
from supervision import cli
from supervision.command import Command


def main(arguments: Optional[List[str]] = None) -> int:
    """Run a command.

    Args:
        arguments: Command and its options; None: those of the process.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    return cli.main(commands.FOLDER, arguments, _prepare)


def _prepare(command: Command) -> None:
    if isinstance(command, GraphOptions):
        preload_nodes()
