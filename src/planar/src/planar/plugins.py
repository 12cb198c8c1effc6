"""Plugins: custom classes found by name and checked against a contract before use.

``my_package.my_module/MyPlanner`` is the class ``MyPlanner`` of a module on Python's path. A name without a
dot, ``my_package/MyPlanner``, is looked up among the entry points of the contract's group, so that a package
installed with pip can offer its classes under its own names.
"""

import importlib
import importlib.util
import inspect
from contextlib import contextmanager
from dataclasses import dataclass, is_dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Iterable, Iterator, List, Optional, Tuple, Type

from planar.errors import SettingsError


class PluginError(SettingsError):
    """A plugin cannot be loaded or violates its contract."""


@dataclass(frozen=True)
class PluginContract:
    """Requirements for a custom class.

    Attributes:
        kind: Description for people, e.g. ``local planner``.
        protocol: Class with the required methods and their parameters.
        settings: Dataclass from which the ``Settings`` of the class derive, and which it uses if it has none;
            None if classes of this kind have no settings.
        group: Entry-point group that offers such classes.
    """

    kind: str
    protocol: type
    settings: Optional[type]
    group: str

    def violations(self, found: Any) -> List[str]:
        """Return what an object lacks, one text for each violation; empty if it satisfies the contract."""
        if not inspect.isclass(found):
            return ["it is not a class"]
        methods = [
            (name, member) for name, member in vars(self.protocol).items() if inspect.isfunction(member)
        ]
        # Before Python 3.11 a protocol without __init__ inherits one of typing.
        methods = [(name, member) for name, member in methods if member.__module__ != "typing"]
        needed = [
            (name, member) for name, member in methods if name == "__init__" or not name.startswith("_")
        ]
        lacks = [text for name, member in needed for text in _lacking(found, name, member)]
        if self.settings is not None:
            own = getattr(found, "Settings", self.settings)
            if not (inspect.isclass(own) and is_dataclass(own) and issubclass(own, self.settings)):
                lacks.append(f"its Settings is not a dataclass derived from {self.settings.__name__}")
        return lacks

    def settings_of(self, found: type) -> type:
        """Return a settings dataclass for one class: its own, or a subclass of the contract's."""
        assert self.settings is not None, f"a {self.kind} has no settings"
        own = getattr(found, "Settings", None)
        return own or type(f"{found.__name__}Settings", (self.settings,), {"__doc__": self.settings.__doc__})


def load_plugin(name: str, contract: PluginContract) -> Optional[type]:
    """Load a plugin and check it.

    Args:
        name: ``module/Class`` with a dot in the module, or the name of an entry point.
        contract: Contract of the kind of plugin.

    Returns:
        The class; None if the name has no dot and is no entry point.

    Raises:
        PluginError: If it does not exist, or with everything it lacks.
    """
    module, _, class_name = name.rpartition("/")
    if "." in module:
        found = _from_module(name, module, class_name)
    else:
        entry = next((each for each in _entry_points(contract.group) if each.name == name), None)
        if entry is None:
            return None
        found = _from_module(name, *entry.value.split(":"))
    lacks = contract.violations(found)
    if lacks:
        raise PluginError(f"{name} is no {contract.kind}: {', '.join(lacks)}")
    return found


def check_plugin_name(parameter: str, name: str, contract: PluginContract) -> None:
    """Check that a parameter names a plugin.

    Raises:
        PluginError: If there is no such class, or with everything it lacks.
    """
    if load_plugin(name, contract) is None:
        example = f"my_package.my_module/My{contract.kind.rpartition(' ')[2].title()}"
        raise PluginError(f"{parameter} must be like {example}, got {name!r}")


@contextmanager
def errors_raised_as(name: str, failure: Type[Exception]) -> Iterator[None]:
    """Convert every exception of a block of custom code to ``failure``, with the name of the plugin."""
    try:
        yield
    except Exception as error:
        raise failure(f"{name} raised {type(error).__name__}: {error}") from error


def load_object(name: str) -> Any:
    """Return the attribute that ``module/attribute`` names. Raises PluginError if it does not exist."""
    module, _, attribute = name.rpartition("/")
    if not (module and attribute):
        raise PluginError(f"{name}: must be like my_package.my_module/MyClass")
    return _from_module(name, module, attribute)


def source_files(names: Iterable[str]) -> Tuple[Path, ...]:
    """Return the existing source files of the modules of dotted plugin names, in order."""
    modules = [name.rpartition("/")[0] for name in names]
    files = [_file_of(module) for module in modules if "." in module]
    return tuple(Path(file) for file in files if file)


def _file_of(module: str) -> Optional[str]:
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError):  # no such package, or an invalid name
        return None
    return spec.origin if spec is not None else None


def _from_module(name: str, module: str, class_name: str) -> Any:
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise PluginError(f"{name}: no module {error.name} on Python's path") from error
    except Exception as error:  # custom modules may raise anything
        raise PluginError(f"{name}: importing {module} raised {type(error).__name__}: {error}") from error
    if not hasattr(found, class_name):
        raise PluginError(f"{name}: no {class_name} in {found.__file__}")
    return getattr(found, class_name)


def _lacking(found: type, name: str, required: Any) -> List[str]:
    """Return what is wrong with one method."""
    parameters = list(inspect.signature(required).parameters.values())
    needed = f"{name}({', '.join(each.name for each in parameters[1:])})"
    method = getattr(found, name, None)
    if not callable(method):
        return [f"it has no {needed}"]
    try:
        inspect.signature(method).bind(*parameters)
    except TypeError:
        return [f"it cannot be called as {needed}"]
    except ValueError:  # compiled classes have no signature
        return []
    return []


def _entry_points(group: str) -> Tuple[Any, ...]:
    found: Any = metadata.entry_points()
    # Before Python 3.10 it is a dictionary by group.
    return tuple(found.select(group=group) if hasattr(found, "select") else found.get(group, ()))
