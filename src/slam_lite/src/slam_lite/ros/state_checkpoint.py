"""Checkpoints of the map, for a node that resumes after a crash."""

import math
import threading
import time
from dataclasses import asdict
from functools import partial

import rospy

from planar import Pose2
from planar_ros.node.checkpoint import FileCheckpoint, SavedFile
from slam_lite.ros.thread_safe_mapper import ThreadSafeMapper
from slam_lite.state import save_state

# Time between checkpoints by the stamps of scans [s], and the largest share of the time to spend on them.
CHECKPOINT_SECONDS, MAX_TIME_SHARE = 2.0, 0.05


class StateCheckpointer:
    """Saves the mapper's state in its own thread, after recovering the checkpoint of a crashed node."""

    def __init__(self, mapper: ThreadSafeMapper):
        """Recover the last checkpoint, if there is one, and start the thread.

        Args:
            mapper: Mapper whose state is saved.
        """
        self._mapper = mapper
        self._checkpoint = FileCheckpoint()
        self._is_due = threading.Event()
        self._stamp = -math.inf
        self._checkpoint.recovered(self._recover)
        threading.Thread(target=self._save_when_due, daemon=True).start()
        rospy.on_shutdown(self._is_due.set)

    def on_scan(self, stamp: float) -> None:
        """Mark a checkpoint as due if the last one is old enough.

        Args:
            stamp: Time of the inserted scan [s].
        """
        if not 0.0 <= stamp - self._stamp < CHECKPOINT_SECONDS:
            self._stamp = stamp
            self._is_due.set()

    def _recover(self, saved: SavedFile) -> None:
        self._mapper.recover(str(saved.path), Pose2.from_dict(saved.value))

    def _save_when_due(self) -> None:
        while not rospy.is_shutdown():
            self._is_due.wait()
            self._is_due.clear()
            begin = time.monotonic()
            self._save()
            time.sleep((time.monotonic() - begin) / MAX_TIME_SHARE)

    def _save(self) -> None:
        state, odom_in_map = self._mapper.snapshot()
        if len(state.poses) > 0:
            self._checkpoint.save(partial(save_state, state, is_compressed=False), asdict(odom_in_map))
