"""Contract of a command, and how commands are found."""

import importlib
import pkgutil
from dataclasses import is_dataclass
from typing import Iterable, List, Protocol, Type

from planar.extensions import ExtensionPoint


class Command(Protocol):
    """What a script runs: a module of the folder ``commands``; it needs no registration.

    ``commands/count_walls.py`` defines the frozen dataclass ``CountWalls`` for ``scripts/count_walls.sh``.
    Its fields are the options (see supervision.command_line), the first line of its docstring is the
    summary. A custom command is a class anywhere on Python's path and is called by its dotted name.

    Life cycle: the module is imported when its script is called, or when ``--help`` lists all summaries; so
    import at its top only what loads fast, and the rest in ``run``. The options are parsed into an instance,
    ``run`` is called once. Ctrl-C ends the process at once, unless ``raise_when_interrupted`` was called
    first, as Run does, because there is something to clean up.
    """

    def run(self) -> int:
        """Run the command.

        Returns:
            Exit code: 0 success, 1 failure.

        Raises:
            PlanarError: Bad input (exit code 2), if possible before anything is started.
            LaunchError: The graph did not start.
            RunInterruptedError: Ctrl-C was pressed.
        """


def _requirements(found: type) -> Iterable[str]:
    if not is_dataclass(found):
        yield "make it a dataclass whose fields are the options"


CONTRACT: ExtensionPoint[Command] = ExtensionPoint(
    "command", Command, "home_service.commands", requirements=_requirements
)


class CommandFolder:
    """Commands in a package's folder.

    Args:
        name: Dotted name of the folder as a package.
        path: Its ``__path__``.
    """

    def __init__(self, name: str, path: Iterable[str]):
        self._name, self._path = name, path

    def names(self) -> List[str]:
        """Return the names of the commands."""
        return [module.name for module in pkgutil.iter_modules(self._path)]

    def find(self, name: str) -> Type[Command]:
        """Return a command by its name or by a dotted name like ``my_package.my_module/MyCommand``.

        No other command is imported.

        Raises:
            PluginError: If there is no such class, or it is no command.
        """
        if "/" in name:
            return CONTRACT.load_required(name)
        module = importlib.import_module(f"{self._name}.{name}")
        return getattr(module, name.title().replace("_", ""))
