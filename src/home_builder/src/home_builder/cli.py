"""Entry point of the commands behind the scripts."""

from typing import List, Optional

from home_builder import commands
from supervision import cli


def main(arguments: Optional[List[str]] = None) -> int:
    """Run a command.

    Args:
        arguments: Command and its options; None: those of the process.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    return cli.main(commands.FOLDER, arguments)
