"""A file that a node leaves for the next of its name, should it end all of a sudden."""

import json
import threading
import xmlrpc.client
from contextlib import suppress
from pathlib import Path
from typing import Any, Callable, List, NamedTuple, Optional

import rosgraph
import rospkg
import rospy

from planar import FileWriteError
from planar_ros.node.parameters import ParameterWriter


class ParameterCheckpoint:
    """A value made of what JSON knows, in the parameter ``~keepsake/value`` of the master.

    Whoever is started anew after a crash or a ``kill -9`` finds it; a node that ends in order takes it away.
    For one thread.
    """

    def __init__(self):
        self._name = rospy.resolve_name("~keepsake/value")
        self._writer = ParameterWriter()
        self._kept = rospy.get_param(self._name, "")
        rospy.on_shutdown(self._forget)

    @property
    def latest(self) -> Optional[Any]:
        """What an earlier node has left, or this one has kept since; None if there is nothing."""
        return json.loads(self._kept) if self._kept else None

    def save(self, value: Any) -> None:
        """From now on this is what is found; costs nothing if it is the same."""
        text = json.dumps(value)
        if text != self._kept:
            self._kept = text
            self._writer.write({self._name: text})

    def _forget(self) -> None:
        with suppress(OSError, xmlrpc.client.Error):  # a master that is gone has nothing left to forget
            xmlrpc.client.ServerProxy(rosgraph.get_master_uri()).deleteParam(rospy.get_name(), self._name)


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
        self._checkpoint = ParameterCheckpoint()
        self._remove(but=self.latest and self.latest.path)

    @property
    def latest(self) -> Optional[SavedFile]:
        """What an earlier node has left, or this one has kept since; None if there is nothing."""
        told = self._checkpoint.latest
        return None if told is None else SavedFile(Path(told["path"]), told["value"])

    def save(self, write: Callable[[Path], None], value: Any) -> None:
        """From now on this is what is found; if that cannot be, a warning tells so.

        ``write`` writes the file, and may raise FileWriteError.
        """
        with self._lock:
            if self._is_closed:
                return
            before = self.latest and self.latest.path
            path = next(one for one in self._both() if one != before)
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                write(path)
            except (OSError, FileWriteError) as error:
                rospy.logwarn_throttle(ALARM_SECONDS, "nothing is kept for a node after this one: %s", error)
                return
            self._checkpoint.save({"path": str(path), "value": value})

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
