"""The mapper of the node, shared by its threads."""

import threading
from typing import NamedTuple, Optional, Tuple

import numpy as np
import rospy

from planar import Pose2, Scan
from planar.geometry.pose import check_pose
from planar_ros.lockstep import LockstepClient
from slam_lite.config import NodeSettings
from slam_lite.map_localizer import MapLocalizer
from slam_lite.mapper import Mapper, PoseUpdate
from slam_lite.rendering import Evidence, SessionRenderer
from slam_lite.state import MapState, load_state


class RenderJob(NamedTuple):
    """Input of the next map.

    Attributes:
        renderer: Renderer of the previous map.
        evidence: Beams and poses of all keyframes.
        information: (3, 3), of the robot's pose, 1 / (m, m, rad)^2; None if unknown.
    """

    renderer: SessionRenderer
    evidence: Evidence
    information: Optional[np.ndarray]


class ThreadSafeMapper:
    """Guards one Mapper, or a MapLocalizer if ``localization_only``, with one lock.

    Loops are closed in a separate thread, so that scans do not wait for it; in a synchronised node, when the
    callbacks of a tick are done.

    Attributes:
        odom_in_map: Odometry frame in the map frame.
    """

    def __init__(self, settings: NodeSettings):
        """Create a mapper without keyframes.

        Args:
            settings: Settings of the node.
        """
        self._settings = settings
        self._lock = threading.RLock()
        self._has_new_keyframes = threading.Condition(self._lock)
        self._mapper = Mapper(settings, deferred=True)
        self._localizer: Optional[MapLocalizer] = None
        self._renderer = self._new_renderer()
        self._base_in_odom: Optional[Pose2] = None
        self._information: Optional[np.ndarray] = None
        self._is_recovering = False
        self.odom_in_map = Pose2()

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[PoseUpdate]:
        """Insert one scan.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            scan: The scan.

        Returns:
            Pose at the scan; None if it was dropped because the robot stands still.

        Raises:
            PlanarError: As ``Mapper.insert``.
        """
        with self._lock:
            self._base_in_odom = base_in_odom
            if self._is_recovering:
                self._is_recovering = False
                self._resume_near(self.odom_in_map @ base_in_odom)
            update = (self._localizer or self._mapper).insert(base_in_odom, scan)
            if update is not None:
                self.odom_in_map = update.odom_in_map
                self._information = update.information
                self._has_new_keyframes.notify_all()
        return update

    def set_pose(self, base_in_map: Pose2) -> None:
        """Continue from another robot pose.

        Args:
            base_in_map: Pose of the base in the map frame.

        Raises:
            OutOfRangeError: The pose is far from the map.
        """
        check_pose(base_in_map, "a robot")
        with self._lock:
            if self._localizer is not None:
                self._localizer.set_pose(base_in_map)
            elif len(self._mapper.keyframe_poses):
                self._resume(self._mapper.state(), base_in_map)
            if self._base_in_odom is not None:
                self.odom_in_map = base_in_map @ self._base_in_odom.inverse()

    def render_job(self) -> RenderJob:
        """Return the input of a map of the present keyframes."""
        with self._lock:
            return RenderJob(self._renderer, self._mapper.evidence(), self._information)

    def state(self) -> MapState:
        """Return the state that is needed to resume later."""
        return self.snapshot()[0]

    def snapshot(self) -> Tuple[MapState, Pose2]:
        """Return the state, and the odometry frame in its map frame."""
        with self._lock:
            return self._mapper.state(), self.odom_in_map

    def load(self, path: str) -> None:
        """Resume from a state file.

        Args:
            path: State file.

        Raises:
            StateFileError: The file cannot be read.
        """
        state = load_state(path)
        settings = self._settings
        with self._lock:
            self._resume(state)
            self._localizer = MapLocalizer(settings, state) if settings.localization_only else None
        rospy.loginfo("loaded a map of %d keyframes from %s", len(state.poses), path)

    def recover(self, path: str, odom_in_map: Pose2) -> None:
        """Resume from a recent checkpoint with continued odometry.

        Args:
            path: State file of the checkpoint.
            odom_in_map: Odometry frame in the map frame at the checkpoint.

        Raises:
            StateFileError: The file cannot be read.
        """
        self.load(path)
        with self._lock:
            self.odom_in_map, self._is_recovering = odom_in_map, True

    def _resume_near(self, base_in_map: Pose2) -> None:
        if self._localizer is not None:
            self._localizer.set_pose(base_in_map)
        else:
            self._mapper.resume_near(self._mapper.state(), base_in_map)

    def _resume(self, state: MapState, base_in_map: Optional[Pose2] = None) -> None:
        mapper = Mapper(self._settings, deferred=True)
        mapper.resume(state, base_in_map)
        self._mapper = mapper
        self._renderer = self._new_renderer()

    def _new_renderer(self) -> SessionRenderer:
        return SessionRenderer(self._settings.resolution, self._settings.occupied_threshold)

    def start_closing_loops(self) -> None:
        """Start the thread that closes loops."""
        threading.Thread(target=self._close_loops_forever, daemon=True).start()

    def close_loops(self) -> None:
        """Run all closure tasks that are due."""
        while self._run_closure_task():
            pass

    def _close_loops_forever(self) -> None:
        step = LockstepClient.of_node()
        while not rospy.is_shutdown():
            if step.is_synchronized or not self._run_closure_task():
                with self._lock:
                    self._has_new_keyframes.wait(timeout=1.0)

    def _run_closure_task(self) -> bool:
        """Run the closure task that is due; return whether there was one."""
        with self._lock:
            mapper = self._mapper
            task = mapper.closure_task() if self._localizer is None else None
        if task is None:
            return False
        result = task.run()
        with self._lock:
            if mapper is not self._mapper:
                return True
            before = mapper.base_in_map
            mapper.apply_closures(result)
            self.odom_in_map = mapper.base_in_map @ before.inverse() @ self.odom_in_map
            if result.moved:
                rospy.loginfo("optimized the map (%d loop closures so far)", mapper.loop_count)
        return True
