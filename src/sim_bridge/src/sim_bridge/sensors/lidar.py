"""A planar range finder (Probabilistic Robotics, section 6.3, p_hit and p_max)."""

import numpy as np

from planar import Pose2, Scan
from sim_bridge.description import LaserProfile
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.noise import NoiseSettings
from sim_bridge.views.section import cast_beams


class Lidar:
    """Sweeps a level section of the world; ``noise``: standard deviation of a range, metres.

    Its beams stay level: on a floor the robot tilts by less than a fifth of a degree.
    """

    def __init__(self, profile: LaserProfile, noise: NoiseSettings, rng: np.random.Generator):
        self._profile = profile
        self._laser_in_base = to_pose2(profile.pose_in_base)
        self._is_upside_down = profile.pose_in_base[2, 2] < 0.0
        self._noise = noise
        self._rng = rng

    def sweep(self, stamp: float, segments: np.ndarray, retros: np.ndarray, base_in_world: Pose2) -> Scan:
        """All beams at one moment.

        ``segments``: (N, 4), what there is to see, as x, y, x, y; ``retros``: (N,), how brightly it reflects.
        """
        profile = self._profile
        laser = base_in_world @ self._laser_in_base
        first = profile.angle_min
        if self._is_upside_down:  # the sweep goes the other way round, so its last beam is the first here
            first = -profile.angle_min - profile.angle_increment * (profile.beams - 1)
        true_ranges, nearest = cast_beams(
            segments,
            laser.x,
            laser.y,
            laser.yaw + first,
            profile.angle_increment,
            profile.beams,
            profile.sight,
        )
        if self._is_upside_down:
            true_ranges, nearest = true_ranges[::-1], nearest[::-1]
        ranges = true_ranges + self._rng.normal(0.0, self._noise.range_noise, profile.beams)
        ranges[ranges < profile.range_min] = profile.too_near
        ranges[ranges > profile.sight] = profile.no_return
        self._fail(ranges)
        brightness = np.append(retros, 0.0)[nearest]
        return Scan(
            stamp=stamp,
            angle_min=profile.angle_min,
            angle_increment=profile.angle_increment,
            ranges=ranges.astype(np.float32),
            range_min=profile.range_min,
            range_max=profile.range_max,
            laser_in_base=self._laser_in_base,
            upside_down=self._is_upside_down,
            intensities=np.where(np.isfinite(ranges), brightness, 0.0).astype(np.float32),
        )

    def _fail(self, ranges: np.ndarray) -> None:
        """Lets some beams measure nothing, and some the greatest range."""
        dropouts, max_readings = self._noise.range_dropouts, self._noise.range_max_readings
        if dropouts + max_readings > 0.0:
            chance = self._rng.random(len(ranges))
            ranges[chance < dropouts] = self._profile.no_return
            ranges[chance > 1.0 - max_readings] = self._profile.range_max
