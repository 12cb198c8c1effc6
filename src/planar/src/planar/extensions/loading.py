"""Objects by name: ``my_package.my_module/MyPlanner``, or an entry point of an installed package."""

import importlib
from importlib import metadata
from typing import Any, Tuple

from planar.errors import SettingsError


class PluginError(SettingsError):
    """A plugin cannot be loaded or violates its contract."""


def find_object(name: str, group: str) -> Any:
    """Return the object that a name stands for; None if the name has no dot and is no entry point.

    Args:
        name: ``module/Class`` with a dot in the module, or the name of an entry point.
        group: Group of the entry points.

    Raises:
        PluginError: It does not exist, or its module cannot be imported.
    """
    module, _, attribute = name.rpartition("/")
    if "." in module:
        return _from_module(name, module, attribute)
    found = next((each for each in _entry_points(group) if each.name == name), None)
    return None if found is None else _from_module(name, *found.value.split(":"))


def load_object(name: str) -> Any:
    """Return the attribute that ``module/attribute`` names. Raises PluginError if it does not exist."""
    module, _, attribute = name.rpartition("/")
    if not (module and attribute):
        raise PluginError(f"{name}: must be like my_package.my_module/MyClass")
    return _from_module(name, module, attribute)


def _from_module(name: str, module: str, attribute: str) -> Any:
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise PluginError(f"{name}: no module {error.name} on Python's path") from error
    except Exception as error:  # custom modules may raise anything
        raise PluginError(f"{name}: importing {module} raised {type(error).__name__}: {error}") from error
    if not hasattr(found, attribute):
        raise PluginError(f"{name}: no {attribute} in {found.__file__}")
    return getattr(found, attribute)


def _entry_points(group: str) -> Tuple[Any, ...]:
    found: Any = metadata.entry_points()
    # Before Python 3.10 it is a dictionary by group.
    return tuple(found.select(group=group) if hasattr(found, "select") else found.get(group, ()))
