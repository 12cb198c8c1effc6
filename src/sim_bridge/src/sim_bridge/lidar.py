"""A planar range finder with Gaussian noise (Probabilistic Robotics, section 6.3, p_hit)."""

import numpy as np

from planar import Scan
from sim_bridge.physics import Physics
from sim_bridge.pose3 import to_pose2, transform_points
from sim_bridge.robots import LaserProfile


class Lidar:
    """Sweeps the world of a Physics from where it is mounted, ``laser_in_base`` (4, 4)."""

    def __init__(
        self, profile: LaserProfile, laser_in_base: np.ndarray, noise: float, rng: np.random.Generator
    ):
        self._profile = profile
        self._laser_in_base = laser_in_base
        self._laser_in_plane = to_pose2(laser_in_base)
        self._noise = noise
        self._rng = rng
        angles = profile.angle_min + profile.angle_increment * np.arange(profile.beams)
        ends = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(profile.beams))) * profile.sight
        self._ends_in_base = transform_points(laser_in_base, ends)
        self._starts_in_base = np.broadcast_to(laser_in_base[:3, 3], ends.shape)

    def sweep(self, stamp: float, physics: Physics, base_in_space: np.ndarray) -> Scan:
        """All beams at one moment."""
        profile = self._profile
        fractions = physics.cast_rays(
            transform_points(base_in_space, self._starts_in_base),
            transform_points(base_in_space, self._ends_in_base),
        )
        ranges = fractions * profile.sight + self._rng.normal(0.0, self._noise, profile.beams)
        ranges[ranges < profile.range_min] = profile.too_near
        ranges[(fractions >= 1.0) | (ranges > profile.sight)] = profile.no_return
        return Scan(
            stamp=stamp,
            angle_min=profile.angle_min,
            angle_increment=profile.angle_increment,
            ranges=ranges.astype(np.float32),
            range_min=profile.range_min,
            range_max=profile.range_max,
            laser_in_base=self._laser_in_plane,
        )
