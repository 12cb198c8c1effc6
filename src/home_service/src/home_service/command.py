"""What a command is."""

from typing import Protocol


class Command(Protocol):
    """What a script does. A command is a module of the folder ``commands``; nothing else has to know of it.

    ``commands/count_walls.py`` holds the frozen dataclass ``CountWalls``: its fields are the options (see
    supervision.command_line), the first line of its docstring is the summary, ``run`` does it. It belongs to
    ``scripts/count_walls.sh``.

    Life cycle: the module is imported when its script is called, or ``--help`` asks for every summary; so it
    imports at its top only what takes no time, and ``run`` imports the rest. The options are parsed into a
    value of the class; ``run`` is called once. Ctrl-C ends the process at once until there is something to
    take down: what makes that calls ``raise_when_interrupted`` first, as Run does.
    """

    def run(self) -> int:
        """Does it; returns the exit code: 0 success, 1 failure.

        Raises PlanarError for bad input (exit code 2), if possible before anything is started; LaunchError
        if a graph does not come up; RunInterruptedError.
        """
