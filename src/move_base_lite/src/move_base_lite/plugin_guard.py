"""Guard around calls of user-defined plugins: errors in them are raised again with their name."""

import math
from contextlib import contextmanager
from typing import Callable, Generic, Iterator, Optional, Type, TypeVar

import numpy as np

from move_base_lite.errors import NavigationError, PluginFailed
from move_base_lite.thread_time import Stopwatch
from planar import Twist2

T = TypeVar("T")
# Seconds of thread time that a call may take; the first may take longer, as numba compiles kernels in it.
MAX_CALL_SECONDS = 1.0


class PluginGuard(Generic[T]):
    """Constructs a plugin at the first call, and checks its calls.

    Args:
        name: Dotted name of the plugin's class, for messages.
        make: Constructs the plugin.
        failure: Error to raise for any failure of the plugin.
    """

    def __init__(self, name: str, make: Callable[[], T], failure: Type[PluginFailed]):
        self.name = name
        self._make = make
        self._plugin: Optional[T] = None
        self._failure = failure
        self._was_called = False

    def fail(self, text: str) -> PluginFailed:
        """Create the error for a fault of the plugin.

        Args:
            text: Description of the fault, to follow the plugin's name.
        """
        return self._failure(f"{self.name} {text}")

    @contextmanager
    def watch(self, *read_only: np.ndarray) -> Iterator[T]:
        """Guard a call of the plugin.

        Args:
            read_only: Arrays that the plugin must not change; they are restored if it does.

        Yields:
            The plugin.

        Raises:
            PluginFailed: The plugin raised anything but a NavigationError, changed the arrays or took too
                long.
        """
        before = [array.tobytes() for array in read_only]
        watch = Stopwatch()
        try:
            if self._plugin is None:
                self._plugin = self._make()
            yield self._plugin
        except NavigationError:
            raise
        except Exception as error:
            raise self.fail(f"raised {type(error).__name__}: {error}") from error
        finally:
            is_changed = False
            for array, content in zip(read_only, before):
                if array.tobytes() != content:
                    array[...] = np.frombuffer(content, array.dtype).reshape(array.shape)
                    is_changed = True
        seconds, self._was_called, is_first = watch.seconds(), True, not self._was_called
        if is_changed:
            raise self.fail("changed what it was given to read")
        if seconds > MAX_CALL_SECONDS and not is_first:
            raise self.fail(f"took {seconds:.1f} s for an answer")

    def check_velocity(self, twist: Twist2) -> None:
        """Check that a velocity of the plugin is finite.

        Args:
            twist: Velocity command.

        Raises:
            PluginFailed: It is not finite.
        """
        if not (math.isfinite(twist.v) and math.isfinite(twist.omega)):
            raise self.fail(f"asked for {twist.v} m/s, {twist.omega} rad/s")
