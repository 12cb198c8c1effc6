"""The facade: a robot with odometry and a laser is localized in a known map."""

import math
from dataclasses import dataclass
from typing import Dict, Optional

import numpy as np

from amcl_lite.beams import Beams, evenly_spaced_beams
from amcl_lite.config import InitialPose, LocalizerSettings
from amcl_lite.likelihood_field import likelihood_field
from amcl_lite.motion_model import moved
from amcl_lite.particles import (
    FreeSpace,
    LocalizationError,
    ParticleSet,
    equally_weighted,
    gaussian_particles,
)
from amcl_lite.resampling import resampled
from amcl_lite.sensor_model import log_beam_model, log_likelihood_field, log_likelihood_field_prob
from amcl_lite.statistics import covariance, has_converged, mean_of_best_cluster
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan, grid_from_picture, wrap


@dataclass(frozen=True)
class Estimate:
    """Where the robot is: the mean of the best cluster, and the covariance (3, 3) of the whole filter."""

    base_in_map: Pose2
    covariance: np.ndarray


class Localizer:
    """Adaptive Monte-Carlo localization (Probabilistic Robotics, tables 8.2 to 8.4), behaving as amcl does.

    Particles are moved by odometry, weighed by how well the scan fits the map at each, and drawn anew by
    weight, as many as their spread requires. When scans fit worse than they used to, some are drawn from all
    free space. Work is done only when the robot has moved; the first scan after a start always counts.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings, rng: np.random.Generator):
        """Starts at the default initial pose. Raises LocalizationError for a map without free cells."""
        self._grid = grid
        self._rng = rng
        self._free_space = FreeSpace(grid)
        self._odom_in_map: Optional[Pose2] = None
        self._configure(settings)
        self._update_requested = False
        self._updated_at: Optional[Pose2] = None
        self._lasers_done: Dict[str, bool] = {}
        self._updates = 0
        start = InitialPose()
        self.set_pose(start.pose, start.covariance)

    @property
    def settings(self) -> LocalizerSettings:
        return self._settings

    @property
    def particles(self) -> ParticleSet:
        return self._particles

    @property
    def odom_in_map(self) -> Optional[Pose2]:
        """Where the odometry frame lies in the map; None before the first estimate."""
        return self._odom_in_map

    @property
    def updates(self) -> int:
        """How many scans have been worked into the filter since the last start."""
        return self._updates

    def set_pose(self, base_in_map: Pose2, pose_covariance: np.ndarray) -> None:
        """Starts anew around a pose; ``pose_covariance``: (3, 3), m^2 and rad^2."""
        if not (base_in_map.is_finite() and np.isfinite(pose_covariance).all()):
            raise LocalizationError("a pose to start from must be finite")
        self._start(gaussian_particles(base_in_map, pose_covariance, self._settings.max_particles, self._rng))

    def scatter(self) -> None:
        """Starts anew with particles all over the free space: global localization."""
        self._start(equally_weighted(self._free_space.draw(self._settings.max_particles, self._rng)))

    def request_update(self) -> None:
        """Makes the next scan count even if the robot stands still."""
        self._update_requested = True

    def update(self, base_in_odom: Pose2, scan: Scan, laser: str = "") -> Optional[Estimate]:
        """Takes in a scan made at ``base_in_odom``; returns an estimate when there is a new one.

        ``laser`` tells several lasers apart. Raises LocalizationError for a scan that cannot be used.
        """
        if not base_in_odom.is_finite():
            raise LocalizationError("odometry must be finite")
        beams = evenly_spaced_beams(scan, self._settings) if self._settings.beams >= 2 else None
        is_first = self._updated_at is None
        if self._updated_at is None:
            self._updated_at = base_in_odom
        elif self._has_moved(self._updated_at, base_in_odom) or self._update_requested:
            self._update_requested = False
            self._lasers_done.clear()
        if self._lasers_done.get(laser):
            return None
        self._lasers_done[laser] = True
        self._move(base_in_odom)
        if beams is not None:
            self._weigh(beams)
        self._updates += 1
        is_resampled = self._updates % self._settings.resample_interval == 0
        if is_resampled:
            self._resample()
        return self._estimate(base_in_odom) if is_resampled or is_first else None

    def _configure(self, settings: LocalizerSettings) -> None:
        self._settings = settings
        self._field = likelihood_field(self._grid, settings.sigma_hit, settings.likelihood_max_distance)
        # amcl's rays end at anything that is not free.
        opaque = np.where(self._grid.cells == FREE, FREE, OCCUPIED).astype(np.int8)
        self._opaque_grid = OccupancyGrid(opaque, self._grid.resolution, self._grid.origin)

    def _start(self, particles: ParticleSet) -> None:
        self._particles = particles
        self._updated_at = None
        self._lasers_done.clear()
        self._update_requested = False
        self._updates = 0
        self._converged = False
        self._weight_slow = self._weight_fast = 0.0

    def _has_moved(self, before: Pose2, base_in_odom: Pose2) -> bool:
        return (
            abs(base_in_odom.x - before.x) > self._settings.update_min_distance
            or abs(base_in_odom.y - before.y) > self._settings.update_min_distance
            or abs(wrap(base_in_odom.yaw - before.yaw)) > self._settings.update_min_angle
        )

    def _move(self, base_in_odom: Pose2) -> None:
        if base_in_odom != self._updated_at:
            poses = moved(self._particles.poses, self._updated_at, base_in_odom, self._settings, self._rng)
            self._particles = ParticleSet(poses, self._particles.weights)
        self._updated_at = base_in_odom

    def _weigh(self, beams: Beams) -> None:
        log_weights = self._log_likelihoods(beams) + np.log(self._particles.weights)
        largest = float(log_weights.max())
        weights = np.exp(log_weights - largest)
        total = float(weights.sum())
        self._particles = ParticleSet(self._particles.poses, weights / total)
        self._remember_likelihood(math.exp(largest) * total)

    def _log_likelihoods(self, beams: Beams) -> np.ndarray:
        poses, settings = self._particles.poses, self._settings
        if settings.sensor_model == "beam":
            return log_beam_model(poses, beams, self._opaque_grid, settings)
        if settings.sensor_model == "likelihood_field_prob":
            skip_beams = settings.beam_skip and self._converged
            return log_likelihood_field_prob(poses, beams, self._field, settings, skip_beams)
        return log_likelihood_field(poses, beams, self._field, settings)

    def _remember_likelihood(self, mean_likelihood: float) -> None:
        """Short-term and long-term averages, whose ratio tells a lost filter (table 8.3)."""
        slow, fast = self._weight_slow, self._weight_fast
        self._weight_slow = _decayed(slow, mean_likelihood, self._settings.recovery_alpha_slow)
        self._weight_fast = _decayed(fast, mean_likelihood, self._settings.recovery_alpha_fast)

    def _resample(self) -> None:
        settings = self._settings
        if settings.selective_resampling and self._particles.effective_size > 0.5 * self._particles.size:
            return
        lost_share = 0.0
        if self._weight_slow > 0.0:
            lost_share = max(0.0, 1.0 - self._weight_fast / self._weight_slow)
        self._particles = resampled(self._particles, settings, lost_share, self._free_space, self._rng)
        if lost_share > 0.0:
            self._weight_slow = self._weight_fast = 0.0
        self._converged = has_converged(self._particles)

    def _estimate(self, base_in_odom: Pose2) -> Estimate:
        base_in_map = mean_of_best_cluster(self._particles)
        self._odom_in_map = base_in_map @ base_in_odom.inverse()
        return Estimate(base_in_map, covariance(self._particles))


def _decayed(average: float, value: float, alpha: float) -> float:
    """An exponential average; 0 means that there is none yet."""
    return value if average == 0.0 else average + alpha * (value - average)


def warm_up(settings: LocalizerSettings) -> None:
    """Compiles, or loads from the cache, all that an update runs, so that the first scan need not wait."""
    grid = grid_from_picture("###\n#.#\n###")
    localizer = Localizer(grid, settings, np.random.default_rng(0))
    localizer.set_pose(Pose2(1.5, 1.5), 0.01 * np.eye(3))
    scan = Scan(0.0, -1.0, 0.5, np.full(5, 0.5, dtype=np.float32), 0.1, 2.0)
    for step in range(settings.resample_interval):
        localizer.request_update()
        localizer.update(Pose2(0.01 * step, 0.0, 0.0), scan)
