"""The mapper: builds a map from scans and odometry."""

import math
from dataclasses import dataclass, replace
from typing import List, Optional, Tuple

import numpy as np

from planar import OccupancyGrid, Pose2, Scan
from planar.errors import OutOfRangeError
from planar.geometry.grid import BandedGrid
from planar.geometry.no_return import NoReturnDetector
from planar.geometry.pose import check_pose
from slam_lite.back_end import BackEnd, ClosureResult, ClosureTask
from slam_lite.config import MapperSettings
from slam_lite.front_end import FrontEnd, RecentKeyframes, TrackedPose
from slam_lite.graph.pose_graph import relative_pose
from slam_lite.keyframes import is_keyframe, prune_keyframes
from slam_lite.odometry.checks import DiscontinuityDetector, MotionFilter
from slam_lite.point_cloud import PointCloud, point_cloud_of
from slam_lite.rendering import Evidence, ScanBeams, beams_of, render_in_bands, without_far_beams
from slam_lite.state import MapState

# Multiple of the distance expected between two searches for loop closures after which one is due in any case.
_SPARSE = 1.5
# Largest distance [m] of a given robot pose from the map: one grid has to contain both.
_MAX_DISTANCE_FROM_MAP = 200.0


@dataclass(frozen=True, eq=False)
class PoseUpdate:
    """Robot pose at a scan.

    Attributes:
        base_in_map: Robot pose in the map frame.
        odom_in_map: Odometry frame in the map frame.
        information: (3, 3), of the pose relative to the keyframes nearby, 1 / (m, m, rad)^2.
        response: Fraction of the scan that matches these keyframes, 0 to 1.
        odometry_chi_square: Squared difference between matched and odometric motion, in units of its
            variance; its mean is 3 if odometry is as accurate as its settings state.
    """

    base_in_map: Pose2
    odom_in_map: Pose2
    information: np.ndarray
    response: float
    odometry_chi_square: float


@dataclass(frozen=True, eq=False)
class MapUpdate(PoseUpdate):
    """Robot pose at a scan, also relative to a keyframe.

    Attributes:
        keyframe: Index of the latest keyframe.
        base_in_keyframe: Robot pose in that keyframe; stays valid when loop closures move the keyframes.
        is_keyframe: Whether the scan itself became that keyframe.
    """

    keyframe: int
    base_in_keyframe: Pose2
    is_keyframe: bool


class Mapper:
    """Graph SLAM with a planar laser.

    A front end tracks the robot by matching scans to recent keyframes; keyframes become nodes of a pose
    graph, in which a back end closes loops; the map is rendered from all keyframes at their present poses.
    The map frame is the odometry frame at the first scan.
    """

    def __init__(self, settings: MapperSettings = MapperSettings(), deferred: bool = False):
        """Create a mapper without keyframes.

        Args:
            settings: Settings of matching, loop closure and rendering.
            deferred: Whether the caller closes loops, by running ``closure_task()`` and passing its result to
                ``apply_closures``, for example in another thread. By default ``insert`` does it.
        """
        self._settings = settings
        self._deferred = deferred
        self._recent = _recent_keyframes(settings)
        self._front_end = FrontEnd(settings, self._recent)
        self._back_end = BackEnd(settings)
        self._beams: List[ScanBeams] = []
        # Number of keyframes at the last search for loop closures.
        self._searched_count = 0
        self._keyframe_in_track: Optional[Pose2] = None
        self._motion_filter = MotionFilter(settings.still_interval)
        self._discontinuity = DiscontinuityDetector()
        self._base_in_keyframe = Pose2()
        self._no_return = NoReturnDetector()
        self._session = 0
        self._sessions: List[int] = []
        # Whether the next scan has to be located in the map, from which pose on, and only near it.
        self._needs_relocalization, self._is_lost = False, False
        self._prior_pose: Optional[Pose2] = None
        self._search_near_prior_only = False

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[MapUpdate]:
        """Insert one scan.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            scan: The scan.

        Returns:
            Pose at the scan; None if it was dropped because the robot stands still.

        Raises:
            OutOfRangeError: Odometry or the resulting pose in the map is out of range; the map is unchanged
                then.
            MatchingError: A custom matcher fails; the map is unchanged then.
        """
        check_pose(base_in_odom, "odometry")
        if self._motion_filter.is_similar(base_in_odom, scan.stamp) and not self._front_end.odometry_is_stuck:
            return None
        max_range, usable_range = ranges_of(scan, self._settings, self._no_return)
        cloud = point_cloud_of(scan, usable_range, self._settings.point_spacing)
        if self._discontinuity.is_discontinuous(base_in_odom, scan.stamp):
            self._needs_relocalization = not self._front_end.relocalize(cloud)
        if self._needs_relocalization:
            self._relocalize(cloud)
        tracked = self._front_end.track(base_in_odom, cloud)
        check_pose(self._in_map(tracked.base_in_track), "a robot in the map")
        is_new_keyframe = is_keyframe(self._in_last_keyframe(tracked.base_in_track), self._settings)
        if is_new_keyframe:
            self._add_keyframe(tracked, cloud, beams_of(scan, max_range, usable_range))
            self._learn_no_return(scan.ranges)
        return self._update(base_in_odom, tracked, is_new_keyframe)

    def closure_task(self) -> Optional[ClosureTask]:
        """Return the loop closure search that is due, None if none is."""
        if not self._settings.close_loops or not self._is_search_due():
            return None
        self._searched_count = len(self._back_end)
        return self._back_end.closure_task()

    def _is_search_due(self) -> bool:
        """Whether there are enough keyframes since the last search, or few that are far apart."""
        settings, new = self._settings, len(self._back_end) - self._searched_count
        if new >= settings.closure_interval or self._searched_count == 0:
            return new >= settings.closure_interval
        moved = relative_pose(self.keyframe_poses, self._searched_count - 1, len(self._back_end) - 1)
        far = _SPARSE * settings.closure_interval * settings.keyframe_distance
        return new > 0 and math.hypot(moved.x, moved.y) > far

    def apply_closures(self, result: ClosureResult) -> None:
        """Apply the result of a closure task.

        Args:
            result: Result of the last task from ``closure_task``.
        """
        self._back_end.apply_closures(result)

    def run_final_optimization(self) -> None:
        """Optimize to convergence and close loops along revisited segments, after the last scan."""
        self._back_end.run_final_optimization()

    @property
    def keyframe_poses(self) -> np.ndarray:
        """Poses (N, 3) of all keyframes in the map frame."""
        return self._back_end.poses

    @property
    def base_in_map(self) -> Pose2:
        """Robot pose at the last scan."""
        count = len(self._back_end)
        return self._back_end.pose(count - 1) @ self._base_in_keyframe if count else Pose2()

    @property
    def loop_count(self) -> int:
        """Number of loop closures in the graph."""
        return int(self._back_end.edges.is_loop.sum())

    @property
    def has_obstacles(self) -> bool:
        """Whether any keyframe has a reading that marks an obstacle."""
        return any(beams.marks.any() for beams in self._beams)

    def evidence(self) -> Evidence:
        """Return the input of a SessionRenderer: the beams of all keyframes and their present poses."""
        older = int(np.searchsorted(self._sessions, self._session))
        return Evidence(list(self._beams), self._back_end.poses.copy(), older)

    def grid(self) -> OccupancyGrid:
        """Render the map of all keyframes at their present poses from scratch."""
        return self.grid_in_bands().assemble()

    def grid_in_bands(self) -> BandedGrid:
        """Render the map band by band on use, so that its cells are never all in memory."""
        return render_in_bands(self.evidence(), self._settings.resolution, self._settings.occupied_threshold)

    def state(self) -> MapState:
        """Return the state that is needed to resume later."""
        return MapState(
            tuple(self._back_end.clouds),
            tuple(self._beams),
            self._back_end.poses.copy(),
            self._back_end.edges,
            self.base_in_map,
            np.array(self._sessions, dtype=np.int64),
        )

    def resume(self, state: MapState, base_in_map: Optional[Pose2] = None) -> None:
        """Resume from a state in a new session.

        Args:
            state: State of an earlier mapper.
            base_in_map: Approximate robot pose. By default the first scan is searched in the map, first near
                the robot's last pose. If that fails, a separate trajectory starts beside the map, and is
                joined with it when a place is recognized.

        Raises:
            OutOfRangeError: ``base_in_map`` is too far from all keyframes; the mapper is unchanged then.
        """
        state = prune_keyframes(state)
        if base_in_map is not None:
            _check_near(base_in_map, state.poses)
        self._back_end = BackEnd(self._settings)
        self._back_end.restore(state.clouds, state.poses, state.edges)
        self._beams = list(state.beams)
        self._searched_count = 0
        self._sessions = list(state.sessions)
        self._session = self._sessions[-1] + 1 if self._sessions else 0
        self._discontinuity = DiscontinuityDetector()
        self._prior_pose, self._is_lost, self._search_near_prior_only = state.base_in_map, False, False
        self._needs_relocalization = base_in_map is None and len(state.poses) > 0
        start = base_in_map or state.base_in_map
        if len(state.poses):
            self._base_in_keyframe = Pose2.from_array(state.poses[-1]).inverse() @ start
        self._start_trajectory(start)

    def resume_near(self, state: MapState, base_in_map: Pose2) -> None:
        """Resume from a recent state at a known pose, for example after a crash.

        The first scan refines the pose if it matches there.

        Args:
            state: State of an earlier mapper.
            base_in_map: Robot pose in the map frame, to within a few decimetres.
        """
        self.resume(replace(state, base_in_map=base_in_map))
        self._search_near_prior_only = True

    def _learn_no_return(self, ranges: np.ndarray) -> None:
        """Learn which readings (N,) mean "no return", and remove them from this session's keyframes."""
        known = self._no_return.distance
        self._no_return.add(ranges)
        distance = self._no_return.distance
        if distance >= known or self._settings.max_range:
            return
        for i in range(int(np.searchsorted(self._sessions, self._session)), len(self._beams)):
            self._beams[i] = without_far_beams(self._beams[i], distance)
            self._back_end.remove_far_points(i, self._beams[i].laser_xy, distance)

    def _relocalize(self, cloud: PointCloud) -> None:
        """Start a trajectory at the pose where the scan matches the map, or beside the map.

        One scan is sufficient in a finished map; in a growing map it may match at another place as well.
        """
        found = None
        if self._prior_pose is not None:
            found = self._back_end.relocalize(cloud, self._prior_pose, only_near=self._search_near_prior_only)
        if self._search_near_prior_only:
            found = found or self._prior_pose
        self._needs_relocalization, self._is_lost = False, found is None
        self._prior_pose, self._search_near_prior_only = None, False
        self._start_trajectory(found or self._back_end.pose_beside(cloud))

    def _start_trajectory(self, base_in_track: Pose2) -> None:
        self._keyframe_in_track = None
        self._recent = _recent_keyframes(self._settings)
        self._front_end = FrontEnd(self._settings, self._recent, base_in_track)

    def _in_last_keyframe(self, base_in_track: Pose2) -> Optional[Pose2]:
        """A pose relative to the last keyframe of this trajectory, None if there is none yet."""
        return None if self._keyframe_in_track is None else self._keyframe_in_track.inverse() @ base_in_track

    def _in_map(self, base_in_track: Pose2) -> Pose2:
        """A tracked pose in the map frame, by the last keyframe if there is one."""
        base_in_keyframe = self._in_last_keyframe(base_in_track)
        if base_in_keyframe is None:
            return base_in_track
        return self._back_end.pose(len(self._back_end) - 1) @ base_in_keyframe

    def _add_keyframe(self, tracked: TrackedPose, cloud: PointCloud, beams: ScanBeams) -> None:
        if self._keyframe_in_track is None:
            self._back_end.add_first(cloud, tracked.base_in_track, self._is_lost)
        else:
            base_in_last = self._keyframe_in_track.inverse() @ tracked.base_in_track
            rotated = _rotated(tracked.information, -self._keyframe_in_track.yaw)
            self._back_end.add(cloud, base_in_last, rotated)
        self._keyframe_in_track = tracked.base_in_track
        self._recent.add(cloud, tracked.base_in_track)
        self._beams.append(beams)
        self._sessions.append(self._session)
        if not self._deferred:
            task = self.closure_task()
            if task is not None:
                self.apply_closures(task.run())

    def _update(self, base_in_odom: Pose2, tracked: TrackedPose, is_new_keyframe: bool) -> MapUpdate:
        assert self._keyframe_in_track is not None
        self._base_in_keyframe = self._keyframe_in_track.inverse() @ tracked.base_in_track
        keyframe = len(self._back_end) - 1
        base_in_map = self._back_end.pose(keyframe) @ self._base_in_keyframe
        return MapUpdate(
            base_in_map,
            base_in_map @ base_in_odom.inverse(),
            tracked.information,
            tracked.response,
            tracked.odometry_chi_square,
            keyframe,
            self._base_in_keyframe,
            is_new_keyframe,
        )


def _recent_keyframes(settings: MapperSettings) -> RecentKeyframes:
    """An empty window; custom matchers may search the coarse map, which the default one does not."""
    return RecentKeyframes(settings.window_keyframes, bool(settings.matcher_plugin))


def ranges_of(scan: Scan, settings: MapperSettings, no_return: NoReturnDetector) -> Tuple[float, float]:
    """Compute the effective ``maxRange`` and ``maxUrange`` for a scan.

    Args:
        scan: The scan.
        settings: ``max_range`` and ``usable_range``, where 0 selects the default.
        no_return: Detector of readings that mean "no return".

    Returns:
        Ranges above which readings are dropped, and above which they mark no obstacle [m].
    """
    max_range = settings.max_range or min(scan.range_max - 0.01, no_return.distance)
    return max_range, settings.usable_range or max_range


def _check_near(base_in_map: Pose2, poses: np.ndarray) -> None:
    """Raise OutOfRangeError for a pose that is far from all of ``poses`` (N, 3), if there are any."""
    check_pose(base_in_map, "a robot")
    distances = np.hypot(poses[:, 0] - base_in_map.x, poses[:, 1] - base_in_map.y)
    if len(poses) and distances.min() > _MAX_DISTANCE_FROM_MAP:
        raise OutOfRangeError(
            f"the robot pose ({base_in_map.x:.1f}, {base_in_map.y:.1f}) is {distances.min():.0f} m away from "
            f"the map; at most {_MAX_DISTANCE_FROM_MAP:.0f} m are allowed"
        )


def _rotated(information: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return rotation @ information @ rotation.T
