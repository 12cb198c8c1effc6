"""Entry point of the commands behind the scripts."""

import sys
from typing import TYPE_CHECKING, List, Optional

from evaluation.preload import preload_nodes
from supervision.interruption import exit_when_interrupted

if TYPE_CHECKING:
    from supervision.command import Command

# Commands that start the nodes of a graph, whose imports then begin before those of the command itself.
GRAPH_COMMANDS = frozenset(
    "add_marker follow home_service launch map_home pick_objects test_navigation test_slam".split()
)
HELP = frozenset(("-h", "--help"))


def main(arguments: Optional[List[str]] = None) -> int:
    """Run a command.

    Args:
        arguments: Command and its options; None: those of the process.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    words = sys.argv[1:] if arguments is None else arguments
    exit_when_interrupted()
    if GRAPH_COMMANDS.intersection(words[:1]) and not HELP.intersection(words):
        preload_nodes()
    from home_service import commands  # late: their imports take as long as those of some nodes
    from supervision import cli

    return cli.main(commands.FOLDER, words, _prepare)


def _prepare(command: "Command") -> None:
    """Import the nodes for a custom command that starts a graph."""
    from evaluation.options import GraphOptions

    if isinstance(command, GraphOptions):
        preload_nodes()
