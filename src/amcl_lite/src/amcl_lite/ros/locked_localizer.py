"""The Localizer of the node, shared by its callbacks."""

import threading
from typing import Optional, Tuple

import numpy as np
import rospy

from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.localizer import Localizer
from amcl_lite.ros.pose_checkpoint import read_initial_pose
from planar import OccupancyGrid, Pose2


class LockedLocalizer:
    """A Localizer, None before the first map, and its settings, guarded by one lock.

    Hold ``lock`` for a sequence of calls to ``localizer``.
    """

    def __init__(self, settings: NodeSettings):
        self.settings = settings
        self.lock = threading.RLock()
        self.localizer: Optional[Localizer] = None
        self._rng = np.random.default_rng(settings.seed if settings.seed >= 0 else None)
        self._pending_pose: Optional[Tuple[Pose2, np.ndarray]] = None

    def set_map(self, grid: OccupancyGrid) -> Localizer:
        """Use a new map, starting at the initial pose or at a pose received before the map.

        Raises LocalizationError if the map has no free cells.
        """
        localizer = Localizer(grid, self.settings, self._rng)
        start = read_initial_pose()
        if start != InitialPose():  # where it starts by itself: particles are drawn once, as without ROS
            localizer.set_pose(start.pose, start.covariance)
        with self.lock:
            if self._pending_pose is not None:
                localizer.set_pose(*self._pending_pose)
                self._pending_pose = None
            self.localizer = localizer
        return localizer

    def set_pose(self, base_in_map: Pose2, covariance: np.ndarray, force_update: bool) -> None:
        """Restart around a pose with covariance (3, 3) [m^2, rad^2], as soon as there is a map."""
        with self.lock:
            if self.localizer is None:
                self._pending_pose = (base_in_map, covariance)
                return
            self.localizer.set_pose(base_in_map, covariance)
            if force_update:
                self.localizer.request_update()

    def start_global_localization(self) -> None:
        """Start global localization, if there is a map."""
        with self.lock:
            if self.localizer is not None:
                rospy.loginfo("Initializing with uniform distribution")
                self.localizer.start_global_localization()

    def request_update(self) -> None:
        """Use the next scan for an update, if there is a map."""
        with self.lock:
            if self.localizer is not None:
                self.localizer.request_update()

    def reconfigure(self, settings: NodeSettings) -> None:
        """Change the settings; as in amcl, the filter restarts around the last estimate."""
        with self.lock:
            self.settings = settings
            if self.localizer is not None:
                self.localizer.reconfigure(settings)
