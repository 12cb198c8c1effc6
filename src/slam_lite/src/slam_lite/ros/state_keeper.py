"""The map kept while it grows, for a node that goes on after a crash."""

import math
import threading
import time
from dataclasses import asdict
from functools import partial

import rospy

from planar import Pose2
from planar_ros.node.kept_file import FileCheckpoint
from slam_lite.ros.mapping import Mapping
from slam_lite.state import StateFileError, save_state

# Seconds of scans from one time to the next, and the most of the node's time that it may take.
KEEP_SECONDS, MOST_SHARE = 2.0, 0.05


class StateKeeper:
    """Keeps a mapping's state in a thread of its own, and first goes on from what a crashed node has left."""

    def __init__(self, mapping: Mapping):
        self._mapping = mapping
        self._kept_file = FileCheckpoint()
        self._is_due = threading.Event()
        self._stamp = -math.inf
        self._take_over()
        threading.Thread(target=self._keep_when_due, daemon=True).start()
        rospy.on_shutdown(self._is_due.set)

    def note_scan(self, stamp: float) -> None:
        """There is a scan of this time: the state is kept when that was done long enough ago."""
        if not 0.0 <= stamp - self._stamp < KEEP_SECONDS:
            self._stamp = stamp
            self._is_due.set()

    def _take_over(self) -> None:
        found = self._kept_file.found
        if found is None:
            return
        try:
            self._mapping.take_over(str(found.path), Pose2(**found.value))
        except StateFileError as error:
            rospy.logwarn("the map of before the crash is lost: %s", error)

    def _keep_when_due(self) -> None:
        while not rospy.is_shutdown():
            self._is_due.wait()
            self._is_due.clear()
            begin = time.monotonic()
            self._keep()
            time.sleep((time.monotonic() - begin) / MOST_SHARE)

    def _keep(self) -> None:
        state, odom_in_map = self._mapping.now()
        if len(state.poses) > 0:
            self._kept_file.keep(partial(save_state, state, is_compressed=False), asdict(odom_in_map))
