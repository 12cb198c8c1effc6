"""The declaration of an extension point, and the guard around the plugins that are made by it."""

import inspect
import math
from dataclasses import dataclass, field, is_dataclass
from functools import partial
from typing import (
    Any,
    Callable,
    FrozenSet,
    Generic,
    Iterable,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    Type,
    TypeVar,
)

from planar.errors import PlanarError
from planar.extensions.loading import PluginError, find_object
from planar.extensions.thread_time import Stopwatch
from planar.extensions.views import read_only

T = TypeVar("T")
# Thread time that a call in a control loop may take [s].
MAX_CALL_SECONDS = 1.0


class InvalidAnswer(Exception):  # noqa: N818  -- reports a fault of the plugin, not of this program
    """The answer of a plugin cannot be used; the text follows the plugin's name."""


@dataclass(frozen=True)
class ExtensionPoint(Generic[T]):
    """What a user-defined class may replace.

    Attributes:
        kind: Description for people, e.g. ``local planner``.
        protocol: Class with the required methods and their parameters.
        group: Entry-point group that offers such classes.
        failure: Error raised for any failure of a plugin.
        passes: Errors that a plugin may raise; they reach the caller as they are.
        answers: By method, ``check(answer, *arguments)``: returns the answer, perhaps converted, or raises
            InvalidAnswer.
        writable: Names of the arguments that a plugin may change; all others are read-only.
        max_seconds: Thread time that a call may take [s]; the first may take longer, as kernels are compiled.
        is_lazy: Whether a plugin is constructed at its first call instead of at once.
        settings: Dataclass from which the ``Settings`` of a class derive, and which it uses if it has none;
            None if classes of this kind have no settings.
        requirements: Further requirements: returns what a class lacks.
        parameter: Parameter of the package that selects a class, if there is one for this.
    """

    kind: str
    protocol: type
    group: str
    failure: Type[PlanarError] = PluginError
    passes: Tuple[Type[Exception], ...] = ()
    answers: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    writable: FrozenSet[str] = frozenset()
    max_seconds: float = math.inf
    is_lazy: bool = False
    settings: Optional[type] = None
    requirements: Callable[[type], Iterable[str]] = lambda found: ()
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

    def load_required(self, name: str, parameter: str = "") -> type:
        """Load a class as ``load`` does, but raise PluginError if the name has no dot and is no entry point.

        Args:
            name: As for ``load``.
            parameter: What has this value, for the message; empty: the kind.
        """
        found = self.load(name)
        if found is None:
            example = f"my_package.my_module/My{self.kind.rpartition(' ')[2].title()}"
            raise PluginError(f"{parameter or self.kind} must be like {example}, got {name!r}")
        return found

    def make(self, name: str, *given: Any) -> T:
        """Construct the class of a name, behind a guard.

        Args:
            name: As for ``load``.
            given: Arguments of the constructor.

        Raises:
            PluginError: There is no such class, or it lacks something.
        """
        return self.guarded(name, partial(self.load_required(name), *given))

    def guarded(self, name: str, make: Callable[[], Any]) -> Any:
        """Return a guard around the object that ``make`` constructs."""
        return Guard(name, self, make)

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


class Guard:
    """Has the methods and attributes of a plugin.

    Args:
        name: Name of the plugin, for messages.
        point: Its extension point.
        make: Constructs the plugin.

    Raises:
        PlanarError: The constructor raised, unless it is called later.
    """

    def __init__(self, name: str, point: ExtensionPoint[Any], make: Callable[[], Any]):
        self._name, self._point, self._make = name, point, make
        self._plugin: Optional[Any] = None
        self._was_called = False
        if not point.is_lazy:
            try:
                self._made()
            except Exception as error:
                raise self._failure(error) from error

    def call(self, method: str, names: Sequence[str], *given: Any, **named: Any) -> Any:
        """Call a method of the plugin.

        Args:
            method: Name of the method.
            names: Names of its arguments.
            given: Arguments.
            named: Further arguments.

        Raises:
            PlanarError: The plugin raised, gave an invalid answer, or took too long.
        """
        watch = Stopwatch() if self._point.max_seconds < math.inf else None
        if named:
            given = (*given, *(named[name] for name in names[len(given) :] if name in named))
        try:
            answer = self._answer(method, names, given)
        except self._point.passes:
            raise
        except Exception as error:
            raise self._failure(error) from error
        is_first, self._was_called = not self._was_called, True
        if watch is not None and not is_first and watch.seconds() > self._point.max_seconds:
            raise self._point.failure(f"{self._name} took {watch.seconds():.1f} s for an answer")
        return answer

    def _answer(self, method: str, names: Sequence[str], given: Sequence[Any]) -> Any:
        writable = self._point.writable
        views = [each if name in writable else _view(each) for name, each in zip(names, given)]
        answer = getattr(self._made(), method)(*views)
        for each, view in zip(given, views):
            if answer is view:
                answer = each
        check = self._point.answers.get(method)
        return answer if check is None else check(answer, *given)

    def _made(self) -> Any:
        if self._plugin is None:
            self._plugin = self._make()
        return self._plugin

    def _failure(self, error: Exception) -> PlanarError:
        what = str(error) if isinstance(error, InvalidAnswer) else f"raised {type(error).__name__}: {error}"
        return self._point.failure(f"{self._name} {what}")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # as copying and pickling ask for
            raise AttributeError(name)
        method = getattr(self._point.protocol, name, None)
        if not inspect.isfunction(method):
            is_optional = name in getattr(self._point.protocol, "__annotations__", ())
            return getattr(self._plugin, name, None) if is_optional else getattr(self._plugin, name)
        call = partial(self.call, name, [*inspect.signature(method).parameters][1:])
        setattr(self, name, call)
        return call


def class_of(plugin: Any) -> type:
    """Return the class of a plugin that may be guarded."""
    return type(plugin._made() if isinstance(plugin, Guard) else plugin)


def _view(given: Any) -> Any:
    return given._made() if isinstance(given, Guard) else read_only(given)


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
