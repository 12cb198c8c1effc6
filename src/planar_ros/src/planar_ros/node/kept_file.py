"""A file that a node leaves for the next of its name, should it end all of a sudden."""

import threading
from pathlib import Path
from typing import Any, Callable, List, NamedTuple, Optional

import rospkg
import rospy

from planar import FileWriteError
from planar_ros.node.keepsake import ParameterCheckpoint

# Wall seconds from one complaint to the next.
ALARM_SECONDS = 60.0


class SavedFile(NamedTuple):
    """``value``: what was known, when the file was written, of what it holds; made of what JSON knows."""

    path: Path
    value: Any


class FileCheckpoint:
    """What is too large for a parameter: a file among the logs, of which a ParameterCheckpoint tells.

    File and value are always of one moment. A node that ends in order leaves neither. For one thread.
    """

    def __init__(self):
        self._lock = threading.Lock()
        self._is_closed = False
        rospy.on_shutdown(self._close)
        self._folder = Path(rospkg.get_log_dir())
        name = rospy.get_name().strip("/").replace("/", "-")
        self._stem = f"{name}-{rospy.get_param('/run_id', 'run')}.kept"
        self._keepsake = ParameterCheckpoint()
        self._remove(but=self.found and self.found.path)

    @property
    def found(self) -> Optional[SavedFile]:
        """What an earlier node has left, or this one has kept since; None if there is nothing."""
        told = self._keepsake.found
        return None if told is None else SavedFile(Path(told["path"]), told["value"])

    def keep(self, write: Callable[[Path], None], value: Any) -> None:
        """From now on this is what is found; if that cannot be, a warning tells so.

        ``write`` writes the file, and may raise FileWriteError.
        """
        with self._lock:
            if self._is_closed:
                return
            before = self.found and self.found.path
            path = next(one for one in self._both() if one != before)
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                write(path)
            except (OSError, FileWriteError) as error:
                rospy.logwarn_throttle(ALARM_SECONDS, "nothing is kept for a node after this one: %s", error)
                return
            self._keepsake.keep({"path": str(path), "value": value})

    def _both(self) -> List[Path]:
        """One is written while the other one is what is found."""
        return [self._folder / f"{self._stem}{number}" for number in range(2)]

    def _close(self) -> None:
        with self._lock:
            self._is_closed = True
            self._remove()

    def _remove(self, but: Optional[Path] = None) -> None:
        """Also what a node has left that died while it wrote."""
        for path in self._folder.glob(f"{self._stem}*"):
            if path != but:
                path.unlink(missing_ok=True)
