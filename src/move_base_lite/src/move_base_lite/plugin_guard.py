"""What the guards of all seams share: other people's code gets the blame for what goes wrong in it."""

import math
from contextlib import contextmanager
from typing import Callable, Generic, Iterator, Optional, Type, TypeVar

import numpy as np

from move_base_lite.errors import NavigationError, PluginFailed
from move_base_lite.thread_time import Stopwatch
from planar import Twist2

T = TypeVar("T")
# Seconds of its own that an answer may take; the first may take longer, as kernels are compiled in it.
MAX_CALL_SECONDS = 1.0


class PluginGuard(Generic[T]):
    """Watches what ``make()`` gives, of the plugin ``name``; raises ``failure`` for all that goes wrong."""

    def __init__(self, name: str, make: Callable[[], T], failure: Type[PluginFailed]):
        self.name = name
        self._make = make
        self._made: Optional[T] = None
        self._failure = failure
        self._has_answered = False

    def fail(self, text: str) -> PluginFailed:
        return self._failure(f"{self.name} {text}")

    @contextmanager
    def watch(self, *lent: np.ndarray) -> Iterator[T]:
        """Around a call of the object; what is ``lent`` to it is given back as it was."""
        before = [array.tobytes() for array in lent]
        watch = Stopwatch()
        try:
            if self._made is None:
                self._made = self._make()
            yield self._made
        except NavigationError:
            raise
        except Exception as error:
            raise self.fail(f"raised {type(error).__name__}: {error}") from error
        finally:
            is_changed = False
            for array, content in zip(lent, before):
                if array.tobytes() != content:
                    array[...] = np.frombuffer(content, array.dtype).reshape(array.shape)
                    is_changed = True
        took, self._has_answered, is_first = watch.seconds(), True, not self._has_answered
        if is_changed:
            raise self.fail("changed what it was given to read")
        if took > MAX_CALL_SECONDS and not is_first:
            raise self.fail(f"took {took:.1f} s for an answer")

    def check_velocity(self, twist: Twist2) -> None:
        if not (math.isfinite(twist.v) and math.isfinite(twist.omega)):
            raise self.fail(f"asked for {twist.v} m/s, {twist.omega} rad/s")
