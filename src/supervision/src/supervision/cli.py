"""Entry point: parse, run the command, return an exit code."""

import argparse
import sys
from typing import Callable, List, Optional

from planar import PlanarError
from supervision import command_line
from supervision.command import Command, CommandFolder
from supervision.display import print_error
from supervision.errors import LaunchError, ResultError
from supervision.interruption import INTERRUPTED, RunInterruptedError, exit_when_interrupted

FAILURE, BAD_INPUT = 1, 2


def main(
    folder: CommandFolder,
    arguments: Optional[List[str]] = None,
    prepare: Callable[[Command], None] = lambda command: None,
) -> int:
    """Run a command.

    Args:
        folder: Folder of the commands.
        arguments: Command and its options; None: those of the process.
        prepare: Called with the command before it is run.

    Returns:
        Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
    """
    exit_when_interrupted()
    try:
        command = parse(sys.argv[1:] if arguments is None else arguments, folder)
        prepare(command)
        return command.run()
    except RunInterruptedError as error:
        print_error(str(error))
        return INTERRUPTED
    except LaunchError as error:
        print_error(str(error))
        return BAD_INPUT if error.is_bad_input else FAILURE
    except ResultError as error:
        print_error(str(error))
        return FAILURE
    except PlanarError as error:
        print_error(str(error))
        return BAD_INPUT


def parse(words: List[str], folder: CommandFolder) -> Command:
    """Parse a command and its options.

    Exits on ``--help`` and on invalid options, with the name of the script that belongs to the command.

    Args:
        words: Name of the command, then its options. A name with a slash is a custom command.
        folder: Folder of the commands.

    Raises:
        PluginError: If a dotted name is no command.
    """
    is_custom = bool(words) and "/" in words[0]
    if not is_custom and (not words or words[0] not in folder.names()):
        _parser_of_names(folder).parse_args(words[:1])
    script = words[0] if is_custom else f"{words[0]}.sh"
    return command_line.parse(folder.find(words[0]), words[1:], script)


def _parser_of_names(folder: CommandFolder) -> argparse.ArgumentParser:
    names = folder.names()
    summaries = {name: command_line.summary(folder.find(name)) for name in names}
    parser = argparse.ArgumentParser(
        prog="home_service",
        description="The commands behind the scripts.",
        epilog="\n".join(f"  {name:<16} {summary}" for name, summary in summaries.items()),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("command", choices=names, metavar="COMMAND", help="one of these; each has a --help")
    return parser
