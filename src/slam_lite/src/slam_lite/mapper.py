"""The mapper: scans and odometry in, poses and a map out."""

import math
from dataclasses import dataclass, replace
from typing import List, Optional, Tuple

import numpy as np

from planar import OccupancyGrid, Pose2, Scan
from planar.geometry.grid import BandedGrid
from planar.geometry.limits import OutOfRangeError
from planar.geometry.pose import check_pose
from slam_lite.back_end import BackEnd, ClosureResult, ClosureTask
from slam_lite.config import MapperSettings
from slam_lite.continuity import Continuity, Pause
from slam_lite.front_end import FrontEnd, KnownScans, RecentScans, Tracked
from slam_lite.loops.relocation import KnownMap
from slam_lite.matching.local_map import LocalMap
from slam_lite.no_return import NoReturn
from slam_lite.rendering import Beams, Evidence, beams_of, drawn_in_bands
from slam_lite.sessions import renewed
from slam_lite.state import MapState
from slam_lite.surface import Surface, surface_of

# Metres off the map that somebody may say the robot is; both have to be drawn as one picture.
_FARTHEST_OFF = 200.0


@dataclass(frozen=True, eq=False)
class PoseUpdate:
    """Where a scan was taken.

    ``information``: (3, 3), of the pose relative to the scans around. ``response``: share of the scan that
    those explain; ``surprise``: squared deviation of the matched from the odometric motion in units of its
    variance, 3 on average for odometry as good as its settings say.
    """

    base_in_map: Pose2
    odom_in_map: Pose2
    information: np.ndarray
    response: float
    surprise: float


@dataclass(frozen=True, eq=False)
class MapUpdate(PoseUpdate):
    """``base_in_key``: the pose relative to the key scan ``key``, which stays true when keys are moved later.

    ``is_key``: the scan itself became that key.
    """

    key: int
    base_in_key: Pose2
    is_key: bool


class Mapper:
    """Graph SLAM with a planar laser.

    A front end follows the robot against its recent scans; key scans become nodes of a pose graph, in which a
    back end closes loops; the map is drawn from all key scans at their present poses. The map frame is the
    odometry frame as it was at the first scan. Without ``deferred``, loops are closed inside ``insert``; with
    it, somebody has to run ``task()`` and ``adopt`` its result now and then.
    """

    def __init__(self, settings: MapperSettings = MapperSettings(), deferred: bool = False):
        self._settings = settings
        self._deferred = deferred
        self._recent = RecentScans(settings.window_keys)
        self._front_end = FrontEnd(settings, self._recent)
        self._back_end = BackEnd(settings)
        self._beams: List[Beams] = []
        self._searched = 0
        self._key_in_track: Optional[Pose2] = None
        self._pause, self._continuity = Pause(settings.still_interval), Continuity()
        self._last_in_key = Pose2()
        self._no_return = NoReturn()
        self._session = 0
        self._sessions: List[int] = []
        # Whether the robot has to be found in the map; where it is believed to be, and whether it is near.
        self._is_to_be_found, self._is_lost = False, False
        self._believed: Optional[Pose2] = None
        self._is_near = False

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[MapUpdate]:
        """Takes one scan in; None if it says nothing new because the robot stands still.

        Raises OutOfRangeError for odometry at which no robot can be, or which leads to such a place in the
        map, MatchingError if a matcher of somebody's own fails; the scan leaves nothing in the map then.
        """
        check_pose(base_in_odom, "odometry")
        if self._pause.lasts(base_in_odom, scan.stamp) and not self._front_end.odometry_is_stuck:
            return None
        max_range, usable_range = ranges_of(scan, self._settings, self._no_return)
        surface = surface_of(scan, usable_range, self._settings.point_spacing)
        if self._continuity.breaks(base_in_odom, scan.stamp):
            self._is_to_be_found = not self._front_end.finds_again(surface)
        if self._is_to_be_found:
            self._find(surface)
        tracked = self._front_end.track(base_in_odom, surface)
        check_pose(self._in_map(tracked.base_in_track), "a robot in the map")
        is_key = self._is_key(tracked.base_in_track)
        if is_key:
            self._no_return.add(scan.ranges)
            self._add_key(tracked, surface, beams_of(scan, max_range, usable_range))
        assert self._key_in_track is not None
        base_in_key = self._key_in_track.inverse() @ tracked.base_in_track
        key = len(self._back_end) - 1
        base_in_map = self._back_end.pose(key) @ base_in_key
        self._last_in_key = base_in_key
        return MapUpdate(
            base_in_map,
            base_in_map @ base_in_odom.inverse(),
            tracked.information,
            tracked.response,
            tracked.surprise,
            key,
            base_in_key,
            is_key,
        )

    def task(self) -> Optional[ClosureTask]:
        """The loop closure search that is due, if one is."""
        settings = self._settings
        if not settings.close_loops or len(self._back_end) < self._searched + settings.closure_interval:
            return None
        self._searched = len(self._back_end)
        return self._back_end.task()

    def adopt(self, result: ClosureResult) -> None:
        """Takes over what a task found."""
        self._back_end.adopt(result)

    def settle(self) -> None:
        """Brings the poses of all keys to rest, as after the last scan."""
        self._back_end.settle()

    @property
    def key_poses(self) -> np.ndarray:
        """Poses (N, 3) in the map of all key scans."""
        return self._back_end.poses

    @property
    def last_in_map(self) -> Pose2:
        """Where the robot was at the last scan."""
        keys = len(self._back_end)
        return self._back_end.pose(keys - 1) @ self._last_in_key if keys else Pose2()

    @property
    def loop_count(self) -> int:
        """How many loop closures tie the graph."""
        return int(self._back_end.edges.is_loop.sum())

    def evidence(self) -> Evidence:
        """What a SessionRenderer draws: the beams of all key scans and their present poses."""
        older = int(np.searchsorted(self._sessions, self._session))
        return Evidence(list(self._beams), self._back_end.poses.copy(), older)

    def grid(self) -> OccupancyGrid:
        """The map of all key scans at their present poses, drawn from scratch."""
        return self.grid_in_bands().joined()

    def grid_in_bands(self) -> BandedGrid:
        """The same map, drawn band by band while it is used: it never takes the memory of all its cells."""
        return drawn_in_bands(self.evidence(), self._settings.resolution, self._settings.occupied_threshold)

    def state(self) -> MapState:
        """All that is needed to go on later."""
        return MapState(
            tuple(self._back_end.surfaces),
            tuple(self._beams),
            self._back_end.poses.copy(),
            self._back_end.edges,
            self.last_in_map,
            np.array(self._sessions, dtype=np.int64),
        )

    def resume(self, state: MapState, base_in_map: Optional[Pose2] = None) -> None:
        """Goes on from a state in a new session, with the robot near ``base_in_map``.

        By default the first scan tells where it is: where it was last, or anywhere else in the map. If that
        cannot be told, a trajectory beside the map begins, to be joined with it when a place is recognised.
        Raises OutOfRangeError, and is as it was then, if ``base_in_map`` is too far from all of the map.
        """
        state = renewed(state)
        if base_in_map is not None:
            _check_near(base_in_map, state.poses)
        self._back_end = BackEnd(self._settings)
        self._back_end.restore(state.surfaces, state.poses, state.edges)
        self._beams = list(state.beams)
        self._searched = 0
        self._sessions = list(state.sessions)
        self._session = self._sessions[-1] + 1 if self._sessions else 0
        self._continuity = Continuity()
        self._believed, self._is_lost, self._is_near = state.base_in_map, False, False
        self._is_to_be_found = base_in_map is None and len(state.poses) > 0
        start = base_in_map or state.base_in_map
        if len(state.poses):
            self._last_in_key = Pose2.from_array(state.poses[-1]).inverse() @ start
        self._begin(start)

    def resume_near(self, state: MapState, base_in_map: Pose2) -> None:
        """Goes on from a state of moments ago, with the robot within some decimetres of ``base_in_map``.

        The first scan tells more exactly where, if it can.
        """
        self.resume(replace(state, base_in_map=base_in_map))
        self._is_near = True

    def _find(self, surface: Surface) -> None:
        """Begins a trajectory where the scan says that the robot is, or beside the map.

        One scan is enough in a finished map; in one that grows, it may look the same elsewhere.
        """
        found = None
        if self._believed is not None:
            found = self._back_end.place_of(surface, self._believed, only_near=self._is_near)
        if self._is_near:
            found = found or self._believed
        self._is_to_be_found, self._is_lost, self._believed, self._is_near = False, found is None, None, False
        self._begin(found or self._back_end.beside(surface))

    def _begin(self, base_in_track: Pose2) -> None:
        self._key_in_track = None
        self._recent = RecentScans(self._settings.window_keys)
        self._front_end = FrontEnd(self._settings, self._recent, base_in_track)

    def _in_map(self, base_in_track: Pose2) -> Pose2:
        """As the latest key has it, if there is one."""
        if self._key_in_track is None:
            return base_in_track
        return self._back_end.pose(len(self._back_end) - 1) @ (self._key_in_track.inverse() @ base_in_track)

    def _is_key(self, base_in_track: Pose2) -> bool:
        if self._key_in_track is None:
            return True
        moved = self._key_in_track.inverse() @ base_in_track
        far = math.hypot(moved.x, moved.y) >= self._settings.key_distance
        return far or abs(moved.yaw) >= self._settings.key_angle

    def _add_key(self, tracked: Tracked, surface: Surface, beams: Beams) -> None:
        if self._key_in_track is None:
            self._back_end.add_first(surface, tracked.base_in_track, self._is_lost)
        else:
            base_in_last = self._key_in_track.inverse() @ tracked.base_in_track
            turned = _rotated(tracked.information, -self._key_in_track.yaw)
            self._back_end.add(surface, base_in_last, turned)
        self._key_in_track = tracked.base_in_track
        self._recent.add(surface, tracked.base_in_track)
        self._beams.append(beams)
        self._sessions.append(self._session)
        if not self._deferred:
            task = self.task()
            if task is not None:
                self.adopt(task.run())


class Follower:
    """Follows the robot in a finished map, which stays as it is.

    Without ``base_in_map`` the first scan tells where the robot is, if it can, or else the last pose does.
    """

    def __init__(self, settings: MapperSettings, state: MapState, base_in_map: Optional[Pose2] = None):
        self._settings = settings
        self._state = state
        self._pause = Pause(settings.still_interval)
        self._no_return = NoReturn()
        self.place(base_in_map or state.base_in_map)
        self._is_to_be_found = base_in_map is None

    def place(self, base_in_map: Pose2) -> None:
        """Says where the robot is; it may be a few decimetres off."""
        known = KnownScans(self._state.surfaces, self._state.poses)
        self._front_end = FrontEnd(self._settings, known, base_in_map)
        self._is_to_be_found = False

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[PoseUpdate]:
        """Follows one scan; None if the robot stands still. Raises what ``Mapper.insert`` raises."""
        check_pose(base_in_odom, "odometry")
        if self._pause.lasts(base_in_odom, scan.stamp) and not self._front_end.odometry_is_stuck:
            return None
        self._no_return.add(scan.ranges)
        _, usable_range = ranges_of(scan, self._settings, self._no_return)
        surface = surface_of(scan, usable_range, self._settings.point_spacing)
        if self._is_to_be_found:
            known = KnownMap(self._state.surfaces, self._state.poses, LocalMap())
            found = known.find([(surface, Pose2())], self._state.base_in_map)
            self.place(found or self._state.base_in_map)
        tracked = self._front_end.track(base_in_odom, surface)
        base_in_map = tracked.base_in_track
        odom_in_map = base_in_map @ base_in_odom.inverse()
        return PoseUpdate(base_in_map, odom_in_map, tracked.information, tracked.response, tracked.surprise)


def ranges_of(scan: Scan, settings: MapperSettings, no_return: NoReturn) -> Tuple[float, float]:
    """maxRange and maxUrange for a scan, metres."""
    max_range = settings.max_range or min(scan.range_max - 0.01, no_return.distance)
    return max_range, settings.usable_range or max_range


def _check_near(base_in_map: Pose2, poses: np.ndarray) -> None:
    """Raises OutOfRangeError for a pose that is nowhere near any of ``poses`` (N, 3), if there are any."""
    check_pose(base_in_map, "a robot")
    distances = np.hypot(poses[:, 0] - base_in_map.x, poses[:, 1] - base_in_map.y)
    if len(poses) and distances.min() > _FARTHEST_OFF:
        raise OutOfRangeError(f"a robot {distances.min():.0f} m away from all that is mapped means nothing")


def _rotated(information: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn @ information @ turn.T
