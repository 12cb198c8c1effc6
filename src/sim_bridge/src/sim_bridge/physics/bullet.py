"""PyBullet without the banner that its C code prints on import."""

import contextlib
import functools
import os
from typing import Any, Iterator


@contextlib.contextmanager
def _quiet_stderr() -> Iterator[None]:
    """Discard what is written to the standard error stream, also by C code."""
    try:
        stderr = os.dup(2)
    except OSError:  # the process has no stderr
        yield
        return
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, 2)
    os.close(devnull)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


with _quiet_stderr():
    import pybullet


class BulletClient:
    """A separate physics engine: PyBullet's functions, bound to its client id."""

    def __init__(self):
        # pybullet_utils' client passes options, which PyBullet prints.
        self._client_id = pybullet.connect(pybullet.DIRECT)

    def __getattr__(self, name: str) -> Any:
        function = functools.partial(getattr(pybullet, name), physicsClientId=self._client_id)
        setattr(self, name, function)
        return function

    def disconnect(self) -> None:
        """Free the engine; PyBullet reuses its id for the next one."""
        if self._client_id >= 0:
            pybullet.disconnect(physicsClientId=self._client_id)
            self._client_id = -1

    def __del__(self):
        with contextlib.suppress(pybullet.error):
            self.disconnect()
