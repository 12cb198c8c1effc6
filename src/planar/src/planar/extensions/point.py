"""The declaration of an extension point."""

import inspect
from dataclasses import dataclass, is_dataclass
from functools import partial
from typing import Any, Callable, Generic, Iterable, List, Optional, TypeVar

from planar.extensions.guard import CallRules, Guard
from planar.extensions.loading import PluginError, find_object

T = TypeVar("T")


def _no_more(found: type) -> Iterable[str]:
    return ()


@dataclass(frozen=True)
class ExtensionPoint(Generic[T]):
    """What a user-defined class may replace.

    Attributes:
        kind: Description for people, e.g. ``local planner``.
        protocol: Class with the required methods and their parameters.
        group: Entry-point group that offers such classes.
        rules: What the caller of the methods relies on.
        settings: Dataclass from which the ``Settings`` of a class derive, and which it uses if it has none;
            None if classes of this kind have no settings.
        requirements: Further requirements: returns what a class lacks.
        parameter: Parameter of the package that selects a class, if there is one for this.
    """

    kind: str
    protocol: type
    group: str
    rules: CallRules = CallRules()
    settings: Optional[type] = None
    requirements: Callable[[type], Iterable[str]] = _no_more
    parameter: str = ""

    @property
    def package(self) -> str:
        """Package that uses such classes."""
        return self.group.partition(".")[0]

    def load(self, name: str) -> Optional[type]:
        """Load a user-defined class and check it.

        Args:
            name: ``my_package.my_module/MyClass``, or the name of an entry point.

        Returns:
            The class; None if the name has no dot and is no entry point.

        Raises:
            PluginError: It does not exist, or it lacks something; the text states all that it lacks.
        """
        found = find_object(name, self.group)
        lacks = [] if found is None else self.violations(found)
        if lacks:
            raise PluginError(f"{name} is no {self.kind}: {', '.join(lacks)}")
        return found

    def check_name(self, parameter: str, name: str) -> None:
        """Check that a parameter names a class of this kind.

        Raises:
            PluginError: There is no such class, or it lacks something.
        """
        if self.load(name) is None:
            example = f"my_package.my_module/My{self.kind.rpartition(' ')[2].title()}"
            raise PluginError(f"{parameter} must be like {example}, got {name!r}")

    def make(self, name: str, *given: Any) -> T:
        """Construct the class of a name, behind a guard.

        Args:
            name: As for ``load``.
            given: Arguments of the constructor.

        Raises:
            PluginError: There is no such class, or it lacks something.
        """
        found = self.load(name)
        if found is None:
            raise PluginError(f"there is no {self.kind} {name!r}")
        return self.guarded(name, partial(found, *given))

    def guarded(self, name: str, make: Callable[[], Any]) -> Any:
        """Return a guard around the object that ``make`` constructs."""
        return Guard(name, self.protocol, self.rules, make)

    def violations(self, found: Any) -> List[str]:
        """Return what an object lacks, one text for each violation; empty if it satisfies the contract."""
        if not inspect.isclass(found):
            return ["it is not a class"]
        lacks = [*self.requirements(found)]
        for name, member in vars(self.protocol).items():
            # Before Python 3.11 a protocol without __init__ inherits one of typing.
            is_needed = inspect.isfunction(member) and member.__module__ != "typing"
            if is_needed and (name == "__init__" or not name.startswith("_")):
                lacks += _lacking(found, name, member)
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


def _lacking(found: type, name: str, required: Any) -> List[str]:
    """Return what is wrong with one method."""
    parameters = [*inspect.signature(required).parameters.values()]
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
