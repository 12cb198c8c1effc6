"""A file that a node leaves for the next of its name, should it end all of a sudden."""

import tempfile
import threading
from pathlib import Path
from typing import Any, Callable, NamedTuple, Optional

import rospkg
import rospy

from planar import FileWriteError
from planar_ros.node.keepsake import Keepsake


class Kept(NamedTuple):
    """``value``: what was known, when the file was written, of what it holds; made of what JSON knows."""

    path: Path
    value: Any


class KeptFile:
    """What is too large for a parameter: a file among the logs, of which a Keepsake tells.

    File and value are always of one moment. A node that ends in order leaves neither. For one thread.
    """

    def __init__(self):
        self._lock = threading.Lock()
        self._is_closed = False
        rospy.on_shutdown(self._close)
        self._keepsake = Keepsake()
        self._path = None if self._keepsake.found is None else Path(self._keepsake.found["path"])

    @property
    def found(self) -> Optional[Kept]:
        """What an earlier node has left, or this one has kept since; None if there is nothing."""
        told = self._keepsake.found
        return None if told is None else Kept(Path(told["path"]), told["value"])

    def keep(self, write: Callable[[Path], None], value: Any) -> None:
        """From now on this is what is found. ``write`` writes the file. Raises FileWriteError."""
        with self._lock:
            if self._is_closed:
                return
            path, before = _new_path(), self._path
            write(path)
            self._keepsake.keep({"path": str(path), "value": value})
            self._path = path
            if before is not None:
                before.unlink(missing_ok=True)

    def _close(self) -> None:
        with self._lock:
            self._is_closed = True
            if self._path is not None:
                self._path.unlink(missing_ok=True)


def _new_path() -> Path:
    """Of a file that nobody has. Raises FileWriteError."""
    folder = Path(rospkg.get_log_dir())
    name = rospy.get_name().strip("/").replace("/", "-")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, prefix=f"{name}-", suffix=".kept", delete=False) as file:
            return Path(file.name)
    except OSError as error:
        raise FileWriteError(f"{folder}: no file can be kept there ({error.strerror})") from None
