"""What a command is, and where commands are found."""

import importlib
import pkgutil
from dataclasses import is_dataclass
from typing import Iterable, List, Protocol, Type

from planar.plugins import PluginContract, PluginError, load_plugin


class Command(Protocol):
    """What a script does. A command is a module of the folder ``commands``; nothing else has to know of it.

    One of other people is a class anywhere on Python's path, called by its dotted name.

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


CONTRACT = PluginContract("command", Command, None, "home_service.commands")


class CommandFolder:
    """The commands of a package's folder ``commands``: its ``name`` as a module, and its ``path``."""

    def __init__(self, name: str, path: Iterable[str]):
        self._name, self._path = name, path

    def names(self) -> List[str]:
        """The commands that there are."""
        return [module.name for module in pkgutil.iter_modules(self._path)]

    def find(self, name: str) -> Type[Command]:
        """The command of that name, or of a dotted name as ``my_package.my_module/MyCommand``.

        No other is imported. Raises PluginError if there is none of that dotted name, or it lacks something.
        """
        if "/" in name:
            return _load_custom(name)
        module = importlib.import_module(f"{self._name}.{name}")
        return getattr(module, name.title().replace("_", ""))


def _load_custom(name: str) -> Type[Command]:
    found = load_plugin(name, CONTRACT)
    if found is None:
        raise PluginError(f"{name} is the dotted name of no command: my_package.my_module/MyCommand is one")
    has_options = is_dataclass(found)
    if not has_options:
        raise PluginError(f"{name} is no command: it is no dataclass, whose fields are the options")
    return found
