"""A planar range finder with Gaussian noise (Probabilistic Robotics, section 6.3, p_hit)."""

import numpy as np

from planar import Pose2, Scan
from sim_bridge.pose3 import to_pose2
from sim_bridge.robots import LaserProfile
from sim_bridge.section import cast_beams


class Lidar:
    """Sweeps a level section of the world; mounted at ``laser_in_base`` (4, 4).

    Its beams stay level: on a floor the robot tilts by less than a fifth of a degree.
    """

    def __init__(
        self, profile: LaserProfile, laser_in_base: np.ndarray, noise: float, rng: np.random.Generator
    ):
        self._profile = profile
        self._laser_in_base = to_pose2(laser_in_base)
        self._noise = noise
        self._rng = rng

    def sweep(self, stamp: float, segments: np.ndarray, base_in_world: Pose2) -> Scan:
        """All beams at one moment. ``segments``: (N, 4), what there is to see, as x, y, x, y."""
        profile = self._profile
        laser = base_in_world @ self._laser_in_base
        true_ranges = cast_beams(
            segments,
            laser.x,
            laser.y,
            laser.yaw + profile.angle_min,
            profile.angle_increment,
            profile.beams,
            profile.sight,
        )
        ranges = true_ranges + self._rng.normal(0.0, self._noise, profile.beams)
        ranges[ranges < profile.range_min] = profile.too_near
        ranges[ranges > profile.sight] = profile.no_return
        return Scan(
            stamp=stamp,
            angle_min=profile.angle_min,
            angle_increment=profile.angle_increment,
            ranges=ranges.astype(np.float32),
            range_min=profile.range_min,
            range_max=profile.range_max,
            laser_in_base=self._laser_in_base,
        )
