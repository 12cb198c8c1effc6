"""Planar range finder (Probabilistic Robotics, section 6.3, p_hit and p_max)."""

import math
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from planar import Pose2, Scan
from planar.geometry.limits import MAX_BEAMS
from sim_bridge.config import SimulationSettings
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.noise import NoiseSettings
from sim_bridge.sdf.values import text
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext
from sim_bridge.sensors.element import SensorElement
from sim_bridge.views.section import cast_beams

STREAM = 1


@dataclass(frozen=True, eq=False)
class LaserProfile:
    """Settings of a planar range finder.

    Attributes:
        frame: Frame of its scans.
        topic: Topic of its scans.
        pose_in_base: Pose (4, 4) in the base frame.
        beams: Number of beams.
        angle_min: Bearing of the first beam in ``frame`` [rad].
        angle_increment: Angle between two beams [rad].
        range_min: Published range_min [m].
        range_max: Published range_max [m].
        sight: Range within which obstacles are measured [m].
        no_return: Reading of a beam that hits nothing within ``sight`` (REP 117) [m].
        too_near: Reading of a beam that hits an obstacle nearer than ``range_min`` (REP 117) [m].
        scan_time: Published scan_time [s].
        rate: Rate of the scans [Hz]; None for that of the simulation.
        noise: Standard deviation of a range [m]; None for that of the simulation.
    """

    frame: str
    topic: str
    pose_in_base: np.ndarray
    beams: int
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    sight: float
    no_return: float = math.inf
    too_near: float = -math.inf
    scan_time: float = 0.0
    rate: Optional[float] = None
    noise: Optional[float] = None

    def build(self, mounting: Mounting) -> "Lidar":
        noise = mounting.settings
        if self.noise is not None and noise.range_noise > 0.0:  # 0: an ideal simulation has no noise
            noise = replace(noise, range_noise=self.noise)
        return Lidar(self, noise, mounting.rng(STREAM), float(mounting.base_in_space[2, 3]))


class Lidar:
    """Measures ranges in a horizontal cross-section of the world.

    Its beams stay horizontal: on a floor the robot tilts by less than a fifth of a degree.

    Args:
        profile: Geometry and limits.
        noise: Errors of ranges.
        rng: Random generator of the noise.
        base_height: Height of the base frame above the world's origin [m].
    """

    on_demand = False

    def __init__(
        self, profile: LaserProfile, noise: NoiseSettings, rng: np.random.Generator, base_height: float = 0.0
    ):
        self.name, self.frame = profile.topic, profile.frame
        self._height = base_height + float(profile.pose_in_base[2, 3])
        self._profile = profile
        self._laser_in_base = to_pose2(profile.pose_in_base)
        self._is_upside_down = profile.pose_in_base[2, 2] < 0.0
        self._noise = noise
        self._rng = rng
        self._retros, self._has_retros = np.empty(0), False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        rate = self._profile.rate or settings.scan_rate
        return Schedule(max(round(settings.physics_rate / rate), 1))

    def measure(self, context: SensorContext) -> Scan:
        return self.sweep(context.stamp, *context.section(self._height), context.base.pose2)

    def sweep(self, stamp: float, segments: np.ndarray, retros: np.ndarray, base_in_world: Pose2) -> Scan:
        """Measure all beams at one instant.

        Args:
            stamp: Time of the scan [simulated s].
            segments: Sides of obstacles (N, 4) as x, y, x, y in the world [m].
            retros: laser_retro (N,) of the sides.
            base_in_world: Pose of the robot's base.

        Returns:
            The scan, with noise.
        """
        profile = self._profile
        laser = base_in_world @ self._laser_in_base
        first = profile.angle_min
        if self._is_upside_down:  # beams are in reverse order
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
        ranges = self._noisy(true_ranges)
        return Scan(
            stamp=stamp,
            angle_min=profile.angle_min,
            angle_increment=profile.angle_increment,
            ranges=ranges,
            range_min=profile.range_min,
            range_max=profile.range_max,
            laser_in_base=self._laser_in_base,
            upside_down=self._is_upside_down,
            intensities=self._intensities(retros, nearest, ranges),
        )

    def _noisy(self, true_ranges: np.ndarray) -> np.ndarray:
        """Return ranges with noise and failed beams, float32 (N,)."""
        from sim_bridge.views.kernels import measure_ranges  # late: it brings numba

        profile, noise, count = self._profile, self._noise, len(true_ranges)
        fail = (noise.range_dropouts, noise.range_max_readings)
        return measure_ranges(
            true_ranges,
            noise.range_noise,
            self._rng.standard_normal(count),
            self._rng.random(count) if sum(fail) > 0.0 else np.empty(0),
            *fail,
            profile.too_near,
            profile.no_return,
            profile.range_min,
            profile.sight,
            profile.range_max,
        )

    def _intensities(self, retros: np.ndarray, nearest: np.ndarray, ranges: np.ndarray) -> np.ndarray:
        """Return the intensity of each beam, float32 (N,); 0 in worlds without laser_retro."""
        if retros is not self._retros:  # the section has changed
            self._retros, self._has_retros = retros, bool(retros.any())
        if not self._has_retros:
            return np.zeros(len(ranges), dtype=np.float32)
        return np.where(np.isfinite(ranges), np.append(retros, 0.0)[nearest], 0.0).astype(np.float32)


def read_laser(element: SensorElement) -> LaserProfile:
    """Read a range finder of Gazebo (gazebo_ros_laser).

    Raises:
        WorldError: A value is not valid.
    """
    sensor = element.sensor
    ray = sensor.child("ray") or sensor.required("lidar")
    horizontal = ray.required("scan").required("horizontal")
    horizontal.required("samples")
    beams = horizontal.count("samples", most=MAX_BEAMS, default=0)
    first, last = (horizontal.required(f"{end}_angle").numbers(1)[0] for end in ("min", "max"))
    span = ray.required("range")
    nearest, farthest = span.required("min").numbers(1)[0], span.required("max").lengths(1)[0]
    if beams < 2 or last <= first or not 0.0 <= nearest < farthest:
        raise sensor.error("a range finder needs two samples, min_angle < max_angle and 0 <= min < max range")
    deviation = ray.child("noise", "stddev")
    return LaserProfile(
        frame=text(element.plugin, "frameName", element.link),
        topic=element.topic("topicName", "scan"),
        pose_in_base=element.pose_in_base,
        beams=beams,
        angle_min=first,
        angle_increment=(last - first) / (beams - 1),
        range_min=nearest,
        range_max=farthest,
        sight=farthest,
        rate=element.update_rate,
        noise=deviation.numbers(1)[0] if deviation is not None else None,
    )
