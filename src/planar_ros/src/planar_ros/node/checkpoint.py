"""Checkpoints from which a restarted node of the same name continues after a crash."""

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
    """A JSON value in the private parameter ``~keepsake/value`` on the parameter server.

    A node that restarts after a crash or ``kill -9`` reads it; a node that shuts down in order deletes it.
    For one thread.
    """

    def __init__(self):
        self._name = rospy.resolve_name("~keepsake/value")
        self._writer = ParameterWriter()
        self._text = rospy.get_param(self._name, "")
        rospy.on_shutdown(self._delete)

    @property
    def latest(self) -> Optional[Any]:
        """The value that an earlier node left, or that was saved last; None if there is none."""
        return json.loads(self._text) if self._text else None

    def save(self, value: Any) -> None:
        """Save a value; costs nothing if it is unchanged."""
        text = json.dumps(value)
        if text != self._text:
            self._text = text
            self._writer.write({self._name: text})

    def _delete(self) -> None:
        with suppress(OSError, xmlrpc.client.Error):  # the master is gone, and the parameter with it
            xmlrpc.client.ServerProxy(rosgraph.get_master_uri()).deleteParam(rospy.get_name(), self._name)


# Wall seconds between warnings.
WARN_SECONDS = 60.0


class SavedFile(NamedTuple):
    """A file of a checkpoint.

    Attributes:
        path: File.
        value: JSON value saved with the file.
    """

    path: Path
    value: Any


class FileCheckpoint:
    """A checkpoint too large for a parameter: a file in the log folder, referred to by a ParameterCheckpoint.

    File and value always belong together. A node that shuts down in order deletes both. For one thread.
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
        """The file that an earlier node left, or that was saved last; None if there is none."""
        saved = self._checkpoint.latest
        return None if saved is None else SavedFile(Path(saved["path"]), saved["value"])

    def save(self, write: Callable[[Path], None], value: Any) -> None:
        """Save a file and a value; if that fails, log a warning.

        Args:
            write: Writes the file to the given path; may raise FileWriteError.
            value: JSON value to be stored with the file.
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
                rospy.logwarn_throttle(WARN_SECONDS, "no checkpoint for a restart of this node: %s", error)
                return
            self._checkpoint.save({"path": str(path), "value": value})

    def _both(self) -> List[Path]:
        """Return the two paths that are written alternately, so that the latest file stays complete."""
        return [self._folder / f"{self._stem}{number}" for number in range(2)]

    def _close(self) -> None:
        with self._lock:
            self._is_closed = True
            self._remove()

    def _remove(self, but: Optional[Path] = None) -> None:
        """Delete all files of this name but one, also partial ones of a node that crashed while writing."""
        for path in self._folder.glob(f"{self._stem}*"):
            if path != but:
                path.unlink(missing_ok=True)
