"""Classes of other people, found by a dotted name and held to a contract before they are used.

``my_package.my_module/MyPlanner`` is the class ``MyPlanner`` of a module on Python's path. A name without a
dot, ``my_package/MyPlanner``, is looked up among the entry points of the contract's group, so that a package
that was installed by pip may offer its classes under names of its own.
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
    """A plugin that cannot be had, or does not keep its contract."""


@dataclass(frozen=True)
class PluginContract:
    """What a class of other people has to have.

    ``kind``: for people, as "local planner". ``protocol``: has the methods, with their parameters.
    ``settings``: the dataclass that the class's own ``Settings`` derive from; they are these if it has none;
    None: classes of this kind have no settings.
    ``group``: of entry points that offer such classes.
    """

    kind: str
    protocol: type
    settings: Optional[type]
    group: str

    def violations(self, found: Any) -> List[str]:
        """What ``found`` lacks, for people; nothing if it keeps the contract."""
        if not inspect.isclass(found):
            return ["it is no class"]
        said = [(name, member) for name, member in vars(self.protocol).items() if inspect.isfunction(member)]
        # Before Python 3.11 a protocol that says nothing of __init__ has one of typing.
        said = [(name, member) for name, member in said if member.__module__ != "typing"]
        needed = [(name, member) for name, member in said if name == "__init__" or not name.startswith("_")]
        lacks = [text for name, member in needed for text in _lacking(found, name, member)]
        if self.settings is not None:
            own = getattr(found, "Settings", self.settings)
            if not (inspect.isclass(own) and is_dataclass(own) and issubclass(own, self.settings)):
                lacks.append(f"its Settings are no dataclass derived from {self.settings.__name__}")
        return lacks

    def settings_of(self, found: type) -> type:
        """A type of settings that is the class's alone."""
        assert self.settings is not None, f"a {self.kind} has no settings"
        own = getattr(found, "Settings", None)
        return own or type(f"{found.__name__}Settings", (self.settings,), {"__doc__": self.settings.__doc__})


def load_plugin(name: str, contract: PluginContract) -> Optional[type]:
    """The class of that name; None if the name is neither dotted nor an entry point's.

    Raises PluginError if it is not there, or with what it lacks.
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
    """Raises PluginError if there is no such class, or with what it lacks."""
    if load_plugin(name, contract) is None:
        example = f"my_package.my_module/My{contract.kind.rpartition(' ')[2].title()}"
        raise PluginError(f"{parameter} must be like {example}, got {name!r}")


@contextmanager
def errors_raised_as(name: str, failure: Type[Exception]) -> Iterator[None]:
    """Around code of other people: whatever that raises is a ``failure`` in its name."""
    try:
        yield
    except Exception as error:
        raise failure(f"{name} raised {type(error).__name__}: {error}") from error


def load_object(name: str) -> Any:
    """What a dotted name, module/attribute, names, whatever it is. Raises PluginError if it is not there."""
    module, _, attribute = name.rpartition("/")
    if not (module and attribute):
        raise PluginError(f"{name}: must be like my_package.my_module/MyClass")
    return _from_module(name, module, attribute)


def source_files(names: Iterable[str]) -> Tuple[Path, ...]:
    """The files of the modules that those of the names name that are dotted, in order; of those there are."""
    modules = [name.rpartition("/")[0] for name in names]
    files = [_file_of(module) for module in modules if "." in module]
    return tuple(Path(file) for file in files if file)


def _file_of(module: str) -> Optional[str]:
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError):  # its package is not there; no name of a module
        return None
    return spec.origin if spec is not None else None


def _from_module(name: str, module: str, class_name: str) -> Any:
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise PluginError(f"{name}: there is no module {error.name} on Python's path") from error
    except Exception as error:  # whatever other people's modules raise
        raise PluginError(f"{name}: {module} fails with {type(error).__name__}: {error}") from error
    if not hasattr(found, class_name):
        raise PluginError(f"{name}: there is no {class_name} in {found.__file__}")
    return getattr(found, class_name)


def _lacking(found: type, name: str, said: Any) -> List[str]:
    """What is wrong with one method."""
    parameters = list(inspect.signature(said).parameters.values())
    needed = f"{name}({', '.join(each.name for each in parameters[1:])})"
    method = getattr(found, name, None)
    if not callable(method):
        return [f"it has no {needed}"]
    try:
        inspect.signature(method).bind(*parameters)
    except TypeError:
        return [f"it cannot be called as {needed}"]
    except ValueError:  # a method without a signature, as of compiled classes
        return []
    return []


def _entry_points(group: str) -> Tuple[Any, ...]:
    found: Any = metadata.entry_points()
    # Before Python 3.10 a dictionary by groups.
    return tuple(found.select(group=group) if hasattr(found, "select") else found.get(group, ()))
