"""Localization in a finished map (localization_only), which stays unchanged."""

from typing import Optional

from planar import Pose2, Scan
from planar.geometry.no_return import NoReturnDetector
from planar.geometry.pose import check_pose
from slam_lite.config import MapperSettings
from slam_lite.front_end import FrontEnd, NearbyKeyframes
from slam_lite.loops.relocalization import Relocalizer
from slam_lite.mapper import PoseUpdate, ranges_of
from slam_lite.matching.local_map import LocalMap
from slam_lite.odometry.checks import MotionFilter
from slam_lite.point_cloud import point_cloud_of
from slam_lite.state import MapState


class MapLocalizer:
    """Tracks the robot in a finished map by scan matching."""

    def __init__(self, settings: MapperSettings, state: MapState, base_in_map: Optional[Pose2] = None):
        """Load the keyframes of the map.

        Args:
            settings: Settings of scan matching.
            state: The map.
            base_in_map: Initial robot pose. By default the first scan is searched in the map; if that fails,
                the last pose of ``state`` is used.
        """
        self._settings = settings
        self._state = state
        self._motion_filter = MotionFilter(settings.still_interval)
        self._no_return = NoReturnDetector()
        self.set_pose(base_in_map or state.base_in_map)
        self._needs_relocalization = base_in_map is None

    def set_pose(self, base_in_map: Pose2) -> None:
        """Set the robot pose.

        Args:
            base_in_map: Pose of the base in the map frame, to within a few decimetres.
        """
        keyframes = NearbyKeyframes(self._state.clouds, self._state.poses)
        self._front_end = FrontEnd(self._settings, keyframes, base_in_map)
        self._needs_relocalization = False

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[PoseUpdate]:
        """Track one scan.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            scan: The scan.

        Returns:
            Pose at the scan; None if it was dropped because the robot stands still.

        Raises:
            PlanarError: As ``Mapper.insert``.
        """
        check_pose(base_in_odom, "odometry")
        if self._motion_filter.is_similar(base_in_odom, scan.stamp) and not self._front_end.odometry_is_stuck:
            return None
        self._no_return.add(scan.ranges)
        _, usable_range = ranges_of(scan, self._settings, self._no_return)
        cloud = point_cloud_of(scan, usable_range, self._settings.point_spacing)
        if self._needs_relocalization:
            relocalizer = Relocalizer(self._state.clouds, self._state.poses, LocalMap())
            found = relocalizer.find_pose([(cloud, Pose2())], self._state.base_in_map)
            self.set_pose(found or self._state.base_in_map)
        tracked = self._front_end.track(base_in_odom, cloud)
        base_in_map = tracked.base_in_track
        odom_in_map = base_in_map @ base_in_odom.inverse()
        return PoseUpdate(
            base_in_map, odom_in_map, tracked.information, tracked.response, tracked.odometry_chi_square
        )
