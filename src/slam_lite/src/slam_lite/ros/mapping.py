"""The one mapper of the node, for all its threads."""

import threading
from typing import NamedTuple, Optional, Tuple

import numpy as np
import rospy

from planar import Pose2, Scan
from planar.geometry.pose import check_pose
from planar_ros.step import LockstepClient
from slam_lite.config import NodeSettings
from slam_lite.mapper import Follower, Mapper, PoseUpdate
from slam_lite.rendering import Evidence, SessionRenderer
from slam_lite.state import MapState, load_state


class Drawing(NamedTuple):
    """What a map is drawn from, and the renderer that drew the one before.

    ``information``: (3, 3), of the robot's pose, if known.
    """

    renderer: SessionRenderer
    evidence: Evidence
    information: Optional[np.ndarray]


class Mapping:
    """Holds one Mapper, or a Follower in localization-only mode, guarded by one lock.

    Loops are closed in a thread of its own, so that they keep no scan waiting; in step, at moments.
    """

    def __init__(self, settings: NodeSettings):
        self._settings = settings
        self._lock = threading.RLock()
        self._has_keys = threading.Condition(self._lock)
        self._mapper = Mapper(settings, deferred=True)
        self._follower: Optional[Follower] = None
        self._renderer = self._empty_renderer()
        self._base_in_odom: Optional[Pose2] = None
        self._information: Optional[np.ndarray] = None
        self._is_taken_over = False
        self.odom_in_map = Pose2()

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[PoseUpdate]:
        """Takes one scan in; None if it says nothing new."""
        with self._lock:
            self._base_in_odom = base_in_odom
            if self._is_taken_over:
                self._is_taken_over = False
                self._go_on_near(self.odom_in_map @ base_in_odom)
            update = (self._follower or self._mapper).insert(base_in_odom, scan)
            if update is not None:
                self.odom_in_map = update.odom_in_map
                self._information = update.information
                self._has_keys.notify_all()
        return update

    def place(self, base_in_map: Pose2) -> None:
        """Goes on from another pose of the robot. Raises OutOfRangeError if it can be nowhere near there."""
        check_pose(base_in_map, "a robot")
        with self._lock:
            if self._follower is not None:
                self._follower.place(base_in_map)
            elif len(self._mapper.key_poses):
                self._go_on(self._mapper.state(), base_in_map)
            if self._base_in_odom is not None:
                self.odom_in_map = base_in_map @ self._base_in_odom.inverse()

    def drawing(self) -> Drawing:
        """What the map is to be drawn from now."""
        with self._lock:
            return Drawing(self._renderer, self._mapper.evidence(), self._information)

    def state(self) -> MapState:
        """All that it takes to go on later."""
        return self.now()[0]

    def now(self) -> Tuple[MapState, Pose2]:
        """The state, and where odometry has its origin in that map."""
        with self._lock:
            return self._mapper.state(), self.odom_in_map

    def load(self, path: str) -> None:
        """Goes on from a saved state. Raises StateFileError if there is none."""
        state = load_state(path)
        settings = self._settings
        with self._lock:
            self._go_on(state)
            self._follower = Follower(settings, state) if settings.localization_only else None
        rospy.loginfo("loaded a map of %d scans from %s", len(state.poses), path)

    def take_over(self, path: str, odom_in_map: Pose2) -> None:
        """Goes on from a state of moments ago; odometry has gone on since. Raises StateFileError."""
        self.load(path)
        with self._lock:
            self.odom_in_map, self._is_taken_over = odom_in_map, True

    def _go_on_near(self, base_in_map: Pose2) -> None:
        if self._follower is not None:
            self._follower.place(base_in_map)
        else:
            self._mapper.resume_near(self._mapper.state(), base_in_map)

    def _go_on(self, state: MapState, base_in_map: Optional[Pose2] = None) -> None:
        mapper = Mapper(self._settings, deferred=True)
        mapper.resume(state, base_in_map)
        self._mapper = mapper
        self._renderer = self._empty_renderer()

    def _empty_renderer(self) -> SessionRenderer:
        return SessionRenderer(self._settings.resolution, self._settings.occupied_threshold)

    def start(self) -> None:
        """Closes loops from now on."""
        threading.Thread(target=self._keep_closing, daemon=True).start()

    def close_loops(self) -> None:
        """Closes what loops there are."""
        while self._close_one():
            pass

    def _keep_closing(self) -> None:
        step = LockstepClient.of_node()
        while not rospy.is_shutdown():
            if step.is_on or not self._close_one():
                with self._lock:
                    self._has_keys.wait(timeout=1.0)

    def _close_one(self) -> bool:
        """Whether there was one."""
        with self._lock:
            mapper = self._mapper
            task = mapper.task() if self._follower is None else None
        if task is None:
            return False
        result = task.run()
        with self._lock:
            if mapper is not self._mapper:
                return True
            before = mapper.last_in_map
            mapper.adopt(result)
            self.odom_in_map = mapper.last_in_map @ before.inverse() @ self.odom_in_map
            if result.moved:
                rospy.loginfo("mended the map (%d loop closures so far)", mapper.loop_count)
        return True
