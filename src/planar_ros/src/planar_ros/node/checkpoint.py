"""Checkpoints: state that a node stores, so that a process that replaces it after a crash resumes its work.

A checkpoint belongs to one piece of work. What a process recovers is what an earlier one left, never what it
has saved itself; a node that ends in order deletes its checkpoint.
"""

import json
import threading
import xmlrpc.client
from contextlib import suppress
from pathlib import Path
from typing import Any, Callable, List, NamedTuple, Optional, TypeVar

import rosgraph
import rospkg
import rospy

from planar import FileWriteError, PlanarError
from planar_ros.node.parameters import ParameterWriter

# What reading a value of an unexpected shape raises.
_MALFORMED = (
    PlanarError,
    LookupError,
    TypeError,
    ValueError,
    AttributeError,
    ArithmeticError,
    RecursionError,
)
T = TypeVar("T")


class ParameterCheckpoint:
    """JSON-compatible state in the node's parameter ``~checkpoint/value``; for one thread."""

    def __init__(self):
        self._name = rospy.resolve_name("~checkpoint/value")
        self._writer = ParameterWriter()
        self._left = self._saved = rospy.get_param(self._name, "")
        rospy.on_shutdown(self._delete)

    def recovered(self, decode: Callable[[Any], Optional[T]]) -> Optional[T]:
        """Return the state that an earlier process of this name left.

        Args:
            decode: Converts the JSON-compatible value; it may raise PlanarError, or what reading a value of
                another shape raises: the checkpoint is then ignored with a warning.

        Returns:
            The converted state; None if there is none, or none of that shape.
        """
        if self._left == "":
            return None
        try:
            return decode(json.loads(self._left))
        except _MALFORMED as error:
            rospy.logwarn(
                "ignoring the checkpoint in %s, starting from scratch: %s: %s",
                self._name,
                type(error).__name__,
                error,
            )
            self._left = ""
            return None

    def save(self, value: Any) -> None:
        """Replace the checkpoint; an unchanged value costs nothing."""
        text = json.dumps(value)
        if text != self._saved:
            self._saved = text
            self._writer.write({self._name: text})

    def _delete(self) -> None:
        with suppress(OSError, xmlrpc.client.Error):  # the master may have ended first
            xmlrpc.client.ServerProxy(rosgraph.get_master_uri()).deleteParam(rospy.get_name(), self._name)


# Wall time between two warnings [s].
WARN_SECONDS = 60.0


class SavedFile(NamedTuple):
    """File of a checkpoint.

    Attributes:
        path: The file.
        value: JSON-compatible state of the moment at which it was written.
    """

    path: Path
    value: Any


class FileCheckpoint:
    """State that is too large for a parameter: a file among the logs, named in a ParameterCheckpoint.

    File and value are always of one moment. A node that ends in order deletes both. For one thread.
    """

    def __init__(self):
        self._lock = threading.Lock()
        self._is_closed = False
        rospy.on_shutdown(self._close)
        self._folder = Path(rospkg.get_log_dir())
        name = rospy.get_name().strip("/").replace("/", "-")
        self._stem = f"{name}-{rospy.get_param('/run_id', 'run')}.kept"
        self._checkpoint = ParameterCheckpoint()
        left = self._checkpoint.recovered(_saved_file)
        self._path = None if left is None else left.path
        self._remove(but=self._path)

    def recovered(self, decode: Callable[[SavedFile], Optional[T]]) -> Optional[T]:
        """Return the state that an earlier process of this name left; see ParameterCheckpoint."""
        return self._checkpoint.recovered(lambda value: decode(_saved_file(value)))

    def save(self, write: Callable[[Path], None], value: Any) -> None:
        """Replace the checkpoint; log a warning if that is impossible.

        Args:
            write: Writes the file; it may raise FileWriteError.
            value: JSON-compatible state that belongs to it.
        """
        with self._lock:
            if self._is_closed:
                return
            path = next(one for one in self._both() if one != self._path)
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                write(path)
            except (OSError, FileWriteError) as error:
                rospy.logwarn_throttle(WARN_SECONDS, "no checkpoint for a restart of this node: %s", error)
                return
            self._path = path
            self._checkpoint.save({"path": str(path), "value": value})

    def _both(self) -> List[Path]:
        """Return the two files: one is written while the other is the checkpoint."""
        return [self._folder / f"{self._stem}{number}" for number in range(2)]

    def _close(self) -> None:
        with self._lock:
            self._is_closed = True
            self._remove()

    def _remove(self, but: Optional[Path] = None) -> None:
        """Remove the files, also of a process that died while it wrote."""
        for path in self._folder.glob(f"{self._stem}*"):
            if path != but:
                path.unlink(missing_ok=True)


def _saved_file(value: Any) -> SavedFile:
    return SavedFile(Path(value["path"]), value["value"])
