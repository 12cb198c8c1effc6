"""The commands of the builder, one module each; a new module in this folder is found automatically."""

from typing import List, Optional

from supervision import cli
from supervision.command import CommandFolder

FOLDER = CommandFolder(__name__, __path__)


def main(arguments: Optional[List[str]] = None) -> int:
    """Run a command.

    Args:
        arguments: Command and its options; None: those of the process.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    return cli.main(FOLDER, arguments)
