"""Guard around a plugin: arguments are read-only, answers are checked, failures carry the plugin's name."""

import inspect
import math
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Callable, FrozenSet, Mapping, Optional, Sequence, Tuple, Type

from planar.errors import PlanarError
from planar.extensions.loading import PluginError
from planar.extensions.thread_time import Stopwatch
from planar.extensions.views import read_only

# Thread time that a call in a control loop may take [s].
MAX_CALL_SECONDS = 1.0


class InvalidAnswer(Exception):  # noqa: N818  -- reports a fault of the plugin, not of this program
    """The answer of a plugin cannot be used; the text follows the plugin's name."""


@dataclass(frozen=True)
class CallRules:
    """What the caller of plugins relies on.

    Attributes:
        failure: Error raised for any failure of a plugin.
        passes: Errors that a plugin may raise; they reach the caller as they are.
        answers: By method, ``check(answer, *arguments)``: returns the answer, perhaps converted, or raises
            InvalidAnswer.
        writable: Names of the arguments that a plugin may change; all others are read-only.
        max_seconds: Thread time that a call may take [s]; the first may take longer, as kernels are compiled.
        is_lazy: Whether the plugin is constructed at its first call instead of at once.
    """

    failure: Type[PlanarError] = PluginError
    passes: Tuple[Type[Exception], ...] = ()
    answers: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    writable: FrozenSet[str] = frozenset()
    max_seconds: float = math.inf
    is_lazy: bool = False


class Guard:
    """Has the methods and attributes of a plugin.

    Args:
        name: Name of the plugin, for messages.
        protocol: Class with the methods that are guarded.
        rules: What the caller relies on.
        make: Constructs the plugin.

    Raises:
        PlanarError: The constructor raised; the rules state the class of the error and whether it is called
            at once.
    """

    def __init__(self, name: str, protocol: type, rules: CallRules, make: Callable[[], Any]):
        self._name, self._protocol, self._rules, self._make = name, protocol, rules, make
        self._plugin: Optional[Any] = None
        self._was_called = False
        if not rules.is_lazy:
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
            PlanarError: The plugin raised, answered what the rules do not allow, or took too long.
        """
        watch = Stopwatch() if self._rules.max_seconds < math.inf else None
        if named:
            given = (*given, *(named[name] for name in names[len(given) :] if name in named))
        try:
            answer = self._answer(method, names, given)
        except self._rules.passes:
            raise
        except Exception as error:
            raise self._failure(error) from error
        is_first, self._was_called = not self._was_called, True
        if watch is not None and not is_first and watch.seconds() > self._rules.max_seconds:
            raise self._rules.failure(f"{self._name} took {watch.seconds():.1f} s for an answer")
        return answer

    def _answer(self, method: str, names: Sequence[str], given: Sequence[Any]) -> Any:
        writable = self._rules.writable
        views = [each if name in writable else _view(each) for name, each in zip(names, given)]
        answer = getattr(self._made(), method)(*views)
        for each, view in zip(given, views):
            if answer is view:
                answer = each
        check = self._rules.answers.get(method)
        return answer if check is None else check(answer, *given)

    def _made(self) -> Any:
        if self._plugin is None:
            self._plugin = self._make()
        return self._plugin

    def _failure(self, error: Exception) -> PlanarError:
        what = str(error) if isinstance(error, InvalidAnswer) else f"raised {type(error).__name__}: {error}"
        return self._rules.failure(f"{self._name} {what}")

    def __getattr__(self, name: str) -> Any:
        method = getattr(self._protocol, name, None)
        if not inspect.isfunction(method):
            return None if self._plugin is None else getattr(self._plugin, name, None)
        call = partial(self.call, name, [*inspect.signature(method).parameters][1:])
        setattr(self, name, call)
        return call


def class_of(plugin: Any) -> type:
    """Return the class of a plugin that may be guarded."""
    return type(plugin._made() if isinstance(plugin, Guard) else plugin)


def _view(given: Any) -> Any:
    return given._made() if isinstance(given, Guard) else read_only(given)
