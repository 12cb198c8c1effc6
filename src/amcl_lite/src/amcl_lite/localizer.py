"""The facade: a robot with odometry and a laser is localized in a known map."""

from dataclasses import dataclass
from typing import Optional, Set

import numpy as np

from amcl_lite.beams import Beams, all_beams, evenly_spaced_beams
from amcl_lite.config import InitialPose, LocalizerSettings
from amcl_lite.likelihood_field import likelihood_field
from amcl_lite.particle_filter import ParticleFilter
from amcl_lite.particles import (
    FreeSpace,
    LocalizationError,
    ParticleSet,
    equally_weighted,
    gaussian_particles,
)
from amcl_lite.quality import LostDetector, Quality, quality_of
from amcl_lite.recovery import find_hypotheses
from amcl_lite.scan_matching import matched
from amcl_lite.sensor_model import log_beam_model, log_likelihood_field, log_likelihood_field_prob
from amcl_lite.statistics import best_cluster, mean_and_covariance
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan, grid_from_picture, wrap

# Of the particles of a lost robot, this share is put where the scan fits the map.
_RECOVERY_SHARE = 0.3


@dataclass(frozen=True)
class Estimate:
    """Where the robot is, and the covariance (3, 3) of the whole filter, in m^2 and rad^2.

    The pose is the mean of the best cluster, improved by scan matching if the settings say so.
    """

    base_in_map: Pose2
    covariance: np.ndarray


class Localizer:
    """Adaptive Monte-Carlo localization (Probabilistic Robotics, tables 8.2 to 8.4), behaving as amcl does.

    Particles are moved by odometry, weighed by how well the scan fits the map at each, and drawn anew by
    weight, as many as their spread requires. When scans fit worse than they used to, some are drawn from all
    free space. Work is done only when the robot has moved; the first scan after a start always counts.

    Beyond amcl it judges how well each scan fits the map at its estimate, and when the robot is lost, looks
    for places where the scan fits and puts particles there.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings, rng: np.random.Generator):
        """Starts at the default initial pose. Raises LocalizationError for a map without free cells."""
        self._grid = grid
        self._rng = rng
        self._free_space = FreeSpace(grid)
        self._odom_in_map: Optional[Pose2] = None
        self._base_in_odom = Pose2()
        self._covariance = np.zeros((3, 3))
        self._quality: Optional[Quality] = None
        self._configure(settings)
        start = InitialPose()
        self.set_pose(start.pose, start.covariance)

    @property
    def settings(self) -> LocalizerSettings:
        return self._settings

    @property
    def particles(self) -> ParticleSet:
        return self._filter.particles

    @property
    def odom_in_map(self) -> Optional[Pose2]:
        """Where the odometry frame lies in the map; None before the first estimate."""
        return self._odom_in_map

    @property
    def updates(self) -> int:
        """How many scans have been worked into the filter since the last start."""
        return self._updates

    @property
    def quality(self) -> Optional[Quality]:
        """How well the last scan fits the map at the estimate; None before the first estimate."""
        return self._quality

    @property
    def is_lost(self) -> bool:
        """Whether scans have not fitted the map for some time; also after ``scatter``, until they do."""
        return self._detector.is_lost

    @property
    def fit_grid(self) -> OccupancyGrid:
        """The likelihood field as a grid of 0 (far from any obstacle) to 100 (on one), to look at."""
        fits = np.rint(100.0 * self._field.fit[1:-1, 1:-1]).astype(np.int8)
        return OccupancyGrid(fits, self._grid.resolution, self._grid.origin)

    def reconfigure(self, settings: LocalizerSettings) -> None:
        """Goes on with other settings, from a new start around the last estimate (as amcl does)."""
        self._configure(settings)
        if self._odom_in_map is not None:
            self.set_pose(self._odom_in_map @ self._base_in_odom, self._covariance)

    def set_pose(self, base_in_map: Pose2, pose_covariance: np.ndarray) -> None:
        """Starts anew around a pose; ``pose_covariance``: (3, 3), m^2 and rad^2."""
        if not (base_in_map.is_finite() and np.isfinite(pose_covariance).all()):
            raise LocalizationError("a pose to start from must be finite")
        count = self._settings.max_particles
        self._start(gaussian_particles(base_in_map, pose_covariance, count, self._rng), is_lost=False)

    def scatter(self) -> None:
        """Starts anew with particles all over the free space: global localization."""
        poses = self._free_space.draw(self._settings.max_particles, self._rng)
        self._start(equally_weighted(poses), is_lost=True)

    def request_update(self) -> None:
        """Makes the next scan count even if the robot stands still."""
        self._update_requested = True

    def update(self, base_in_odom: Pose2, scan: Scan, laser: str = "") -> Optional[Estimate]:
        """Takes in a scan made at ``base_in_odom``; returns an estimate when there is a new one.

        ``laser`` tells several lasers apart. Raises LocalizationError for a scan that cannot be used.
        """
        if not base_in_odom.is_finite():
            raise LocalizationError("odometry must be finite")
        beams = evenly_spaced_beams(scan, self._settings)
        self._base_in_odom = base_in_odom
        estimate = None
        if self._is_due(base_in_odom, laser, scan.stamp):
            self._lasers_done.add(laser)
            estimate = self._take(base_in_odom, scan, beams)
        self._judge(base_in_odom, beams, scan.stamp)
        return estimate

    def _configure(self, settings: LocalizerSettings) -> None:
        self._settings = settings
        self._field = likelihood_field(self._grid, settings.sigma_hit, settings.likelihood_max_distance)
        self._opaque_grid = _opaque(self._grid) if settings.sensor_model == "beam" else None

    def _start(self, particles: ParticleSet, is_lost: bool) -> None:
        self._filter = ParticleFilter(particles, self._rng)
        self._detector = LostDetector(is_lost)
        self._updated_at: Optional[Pose2] = None
        self._updated_stamp = 0.0
        self._lasers_done: Set[str] = set()
        self._update_requested = False
        self._updates = 0

    def _is_due(self, base_in_odom: Pose2, laser: str, stamp: float) -> bool:
        """Whether this laser's scan is to be worked in; after a motion, each laser's next scan is, once."""
        if (
            self._updated_at is None
            or self._has_moved(self._updated_at, base_in_odom)
            or self._has_stood_long(stamp)
            or self._update_requested
        ):
            self._update_requested = False
            self._updated_stamp = stamp
            self._lasers_done.clear()
        return laser not in self._lasers_done

    def _has_moved(self, before: Pose2, base_in_odom: Pose2) -> bool:
        return (
            abs(base_in_odom.x - before.x) > self._settings.update_min_distance
            or abs(base_in_odom.y - before.y) > self._settings.update_min_distance
            or abs(wrap(base_in_odom.yaw - before.yaw)) > self._settings.update_min_angle
        )

    def _has_stood_long(self, stamp: float) -> bool:
        return abs(stamp - self._updated_stamp) * self._settings.update_when_still >= 1.0

    def _take(self, base_in_odom: Pose2, scan: Scan, beams: Beams) -> Optional[Estimate]:
        """Works a scan into the filter."""
        is_first = self._updated_at is None
        if self._updated_at is not None and base_in_odom != self._updated_at:
            self._filter.move(self._updated_at, base_in_odom, self._settings)
        self._updated_at = base_in_odom
        if self._settings.beams >= 2:
            self._filter.weigh(self._log_likelihoods(beams), self._settings)
        self._updates += 1
        is_resampled = self._updates % self._settings.resample_interval == 0
        if is_resampled:
            self._resample(beams)
        return self._estimate(base_in_odom, scan) if is_resampled or is_first else None

    def _log_likelihoods(self, beams: Beams) -> np.ndarray:
        poses, settings = self._filter.particles.poses, self._settings
        if self._opaque_grid is not None:
            return log_beam_model(poses, beams, self._opaque_grid, settings)
        if settings.sensor_model == "likelihood_field_prob":
            skip_beams = settings.beam_skip and self._filter.has_converged
            return log_likelihood_field_prob(poses, beams, self._field, settings, skip_beams)
        return log_likelihood_field(poses, beams, self._field, settings)

    def _resample(self, beams: Beams) -> None:
        share, draw = 0.0, self._free_space.draw
        if self._settings.recover_when_lost and self.is_lost:
            hypotheses = find_hypotheses(beams, self._field, self._grid, self._free_space, self._rng)
            if len(hypotheses) > 0:
                share, draw = _RECOVERY_SHARE, hypotheses.draw
        self._filter.resample(self._settings, self._free_space.draw, share, draw)

    def _estimate(self, base_in_odom: Pose2, scan: Scan) -> Estimate:
        cluster = best_cluster(self.particles)
        base_in_map, covariance = mean_and_covariance(cluster)
        if self._settings.refine_pose:
            ends_xy = all_beams(scan, self._settings).ends_xy
            base_in_map = matched(base_in_map, covariance, ends_xy, self._field)
        if cluster is not self.particles:
            _, covariance = mean_and_covariance(self.particles)
        self._odom_in_map = base_in_map @ base_in_odom.inverse()
        self._covariance = covariance
        return Estimate(base_in_map, self._covariance)

    def _judge(self, base_in_odom: Pose2, beams: Beams, stamp: float) -> None:
        if self._odom_in_map is None:
            return
        self._quality = quality_of(self._odom_in_map @ base_in_odom, beams, self._field, self._grid)
        self._detector.take(self._quality, stamp)


def _opaque(grid: OccupancyGrid) -> OccupancyGrid:
    """A grid on which amcl's rays end at anything that is not free."""
    cells = np.full_like(grid.cells, OCCUPIED)
    cells[grid.cells == FREE] = FREE
    return OccupancyGrid(cells, grid.resolution, grid.origin)


def warm_up(settings: LocalizerSettings) -> None:
    """Compiles, or loads from the cache, all that an update runs, so that the first scan need not wait."""
    grid = grid_from_picture("####\n#..#\n####")
    scan = Scan(0.0, -1.0, 0.5, np.full(5, 0.5, dtype=np.float32), 0.1, 2.0)
    localizer = Localizer(grid, settings, np.random.default_rng(0))
    localizer.scatter()
    for step in range(settings.resample_interval):
        localizer.request_update()
        localizer.update(Pose2(0.01 * step, 0.0, 0.0), scan)
