"""Range finder (Probabilistic Robotics, section 6.3, p_hit and p_max)."""

import math
from dataclasses import dataclass, replace
from typing import Optional, Tuple

import numpy as np

from planar import Pose2, Scan
from planar.geometry.limits import MAX_BEAMS
from sim_bridge.config import SimulationSettings
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.noise import NoiseSettings
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.values import text
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext
from sim_bridge.sensors.element import SensorElement
from sim_bridge.sensors.rays import RayGrid, cast_in_space, is_level
from sim_bridge.views.section import cast_beams

STREAM = 1


@dataclass(frozen=True, eq=False)
class LaserProfile:
    """Settings of a range finder.

    Attributes:
        frame: Frame of its scans.
        topic: Topic of its scans.
        pose_in_base: Pose (4, 4) in the base frame.
        beams: Number of ranges of a row.
        angle_min: Bearing of the first beam in ``frame`` [rad].
        angle_increment: Angle between two beams [rad].
        range_min: Published range_min [m].
        range_max: Published range_max [m].
        sight: Range within which obstacles are measured [m].
        no_return: Reading of a beam that hits nothing within ``sight`` (REP 117) [m].
        too_near: Reading of a beam that hits an obstacle nearer than ``range_min`` (REP 117) [m].
        scan_time: Published scan_time [s].
        grid: Rays, if they are not the ``beams`` of one level row.
        noise_mean: Mean error of a range [m].
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
    grid: Optional[RayGrid] = None
    noise_mean: float = 0.0

    def build(self, mounting: Mounting) -> "Lidar":
        noise = mounting.settings
        if self.noise is not None and noise.range_noise > 0.0:  # 0: an ideal simulation has no noise
            noise = replace(noise, range_noise=self.noise)
        return Lidar(self, noise, mounting.rng(STREAM), float(mounting.base_in_space[2, 3]))


class Lidar:
    """Measures ranges: if it is mounted level, in a horizontal cross-section of the world, else in space.

    Beams of a level laser stay horizontal: on a floor the robot tilts by less than a fifth of a degree.

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
        self._grid = profile.grid or _level_row(profile)
        self._directions = np.empty((0, 3))
        if not (self._grid.is_one_level_row and is_level(profile.pose_in_base)):
            self._directions = self._grid.directions()

    def schedule(self, settings: SimulationSettings) -> Schedule:
        rate = self._profile.rate or settings.scan_rate
        return Schedule(max(round(settings.physics_rate / rate), 1))

    def measure(self, context: SensorContext) -> Scan:
        if len(self._directions):
            pose = self._profile.pose_in_base
            lengths, retros = cast_in_space(context, pose, self._directions, self._profile.sight)
            return self._scan(context.stamp, lengths, retros)
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
        laser, grid = base_in_world @ self._laser_in_base, self._grid
        # Beams of a laser that is upside down are in reverse order.
        first = -grid.angle_max if self._is_upside_down else grid.angle_min
        lengths, nearest = cast_beams(
            segments,
            laser.x,
            laser.y,
            laser.yaw + first,
            profile.angle_increment if profile.grid is None else grid.increment,
            grid.columns,
            profile.sight,
        )
        if self._is_upside_down:
            lengths, nearest = lengths[::-1], nearest[::-1]
        if retros is not self._retros:  # the section has changed
            self._retros, self._has_retros = retros, bool(retros.any())
        hit = np.append(retros, 0.0)[nearest] if self._has_retros else np.empty(0)
        return self._scan(stamp, lengths, hit)

    def _scan(self, stamp: float, lengths: np.ndarray, retros: np.ndarray) -> Scan:
        """Return a scan, with noise.

        Args:
            stamp: Time of the scan [simulated s].
            lengths: True length (R,) of each ray, infinite without a hit [m].
            retros: laser_retro (R,) of what the rays hit; empty if nothing has any.
        """
        profile = self._profile
        ranges = self._noisy(self._grid.interpolate(lengths, profile.sight))
        intensities = np.zeros(len(ranges), dtype=np.float32)
        if len(retros):
            seen = np.isfinite(ranges)
            intensities[seen] = self._grid.nearest(retros)[seen]
        return Scan(
            stamp=stamp,
            angle_min=profile.angle_min,
            angle_increment=profile.angle_increment,
            ranges=ranges,
            range_min=profile.range_min,
            range_max=profile.range_max,
            laser_in_base=self._laser_in_base,
            upside_down=self._is_upside_down,
            intensities=intensities,
        )

    def _noisy(self, true_ranges: np.ndarray) -> np.ndarray:
        """Return ranges with noise and failed beams, float32 (N,)."""
        from sim_bridge.views.kernels import measure_ranges  # late: it brings numba

        profile, noise, count = self._profile, self._noise, len(true_ranges)
        fail = (noise.range_dropouts, noise.range_max_readings)
        return measure_ranges(
            true_ranges + profile.noise_mean if profile.noise_mean else true_ranges,
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


def read_laser(element: SensorElement) -> LaserProfile:
    """Read a range finder of Gazebo (gazebo_ros_laser).

    Raises:
        WorldError: A value is not valid.
    """
    sensor = element.sensor
    ray = sensor.child("ray") or sensor.required("lidar")
    horizontal = ray.required("scan").required("horizontal")
    horizontal.required("samples")
    rays, first, last, beams = _sweep(horizontal)
    span = ray.required("range")
    nearest, farthest = span.required("min").numbers(1)[0], span.required("max").lengths(1)[0]
    if not 0.0 <= nearest < farthest:
        raise sensor.error(f"expected 0 <= min < max range, got {nearest:g} and {farthest:g}")
    vertical = ray.child("scan", "vertical")
    elevations, rows = (0.0,), 1
    if vertical is not None:
        count, low, high, rows = _sweep(vertical)
        # As in Gazebo: a single row has no elevation.
        elevations = tuple(np.linspace(low, high, count).tolist()) if count > 1 else (0.0,)
    if max(rays * len(elevations), beams * rows) > MAX_BEAMS:
        raise sensor.error(f"expected at most {MAX_BEAMS} rays, got {rays * len(elevations)}")
    is_level_row = (rays, elevations, rows) == (beams, (0.0,), 1) and beams > 1
    deviation = ray.child("noise", "stddev")
    return LaserProfile(
        frame=text(element.plugin, "frameName", element.link),
        topic=element.topic("topicName", "scan"),
        pose_in_base=element.pose_in_base,
        beams=beams,
        angle_min=first,
        angle_increment=(last - first) / max(beams - 1, 1),
        range_min=nearest,
        range_max=farthest,
        sight=farthest,
        rate=element.update_rate,
        noise=deviation.numbers(1)[0] if deviation is not None else None,
        grid=None if is_level_row else RayGrid(first, last, rays, elevations, beams, rows),
        noise_mean=ray.number("noise", "mean", default=0.0),
    )


def _level_row(profile: LaserProfile) -> RayGrid:
    """Return the rays of a profile without a grid."""
    angle_max = profile.angle_min + profile.angle_increment * (profile.beams - 1)
    return RayGrid(profile.angle_min, angle_max, profile.beams, (0.0,), profile.beams, 1)


def _sweep(scan: Element) -> Tuple[int, float, float, int]:
    """Read <horizontal> or <vertical>.

    Returns:
        Number of rays, first and last angle [rad], and number of ranges: rays times resolution.

    Raises:
        WorldError: A value is not valid.
    """
    rays = scan.count("samples", most=MAX_BEAMS, default=1)
    first, last = (scan.required(f"{end}_angle").numbers(1)[0] for end in ("min", "max"))
    if last < first or (last == first and rays > 1):
        raise scan.error(f"expected min_angle < max_angle for {rays} samples, got {first:g} and {last:g}")
    ranges = int(rays * scan.number("resolution", default=1.0))
    if not 1 <= ranges <= MAX_BEAMS:
        raise scan.error(f"expected 1 to {MAX_BEAMS} ranges (samples * resolution), got {ranges}")
    return rays, first, last, ranges
