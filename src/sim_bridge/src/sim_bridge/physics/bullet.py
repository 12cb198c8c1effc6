"""PyBullet, without what its C code would print into the output of every program."""

import contextlib
import functools
import os
from typing import Any, Iterator


@contextlib.contextmanager
def _quiet_stderr() -> Iterator[None]:
    """Sends what anyone, C code too, writes to the standard error stream to nowhere."""
    try:
        stderr = os.dup(2)
    except OSError:  # a program without one
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


with _quiet_stderr():
    import pybullet


class BulletClient:
    """A physics engine of its own: PyBullet's functions, bound to it."""

    def __init__(self):
        # No options, which pybullet_utils' client gives and PyBullet prints.
        self._number = pybullet.connect(pybullet.DIRECT)

    def __getattr__(self, name: str) -> Any:
        function = functools.partial(getattr(pybullet, name), physicsClientId=self._number)
        setattr(self, name, function)
        return function

    def disconnect(self) -> None:
        """Frees the engine; PyBullet gives its number to the next one."""
        if self._number >= 0:
            pybullet.disconnect(physicsClientId=self._number)
            self._number = -1

    def __del__(self):
        with contextlib.suppress(pybullet.error):
            self.disconnect()
