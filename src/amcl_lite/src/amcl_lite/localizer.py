"""The facade: Monte Carlo localization of a robot with odometry and a laser in a known map."""

from dataclasses import dataclass
from functools import partial
from typing import Callable, Optional, Tuple

import numpy as np

from amcl_lite.belief import Belief
from amcl_lite.config import InitialPose, LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.filter.particle_filter import ParticleFilter
from amcl_lite.filter.particles import (
    FreeSpace,
    ParticleSet,
    equally_weighted,
    gaussian_particles,
    gaussian_poses,
)
from amcl_lite.filter.resampling import DrawPoses
from amcl_lite.filter.statistics import best_cluster, mean_and_covariance
from amcl_lite.motion.motion_model import motion_model_of
from amcl_lite.motion.update_policy import UpdatePolicy
from amcl_lite.recovery.hypotheses import find_hypotheses
from amcl_lite.recovery.pose_search import LastEstimate, PoseSearch
from amcl_lite.recovery.quality import LostDetector, ScanQuality
from amcl_lite.sensor.beams import Beams, all_beams, evenly_spaced_beams
from amcl_lite.sensor.scan_likelihood import ScanLikelihood
from amcl_lite.sensor.scan_matching import match_scan
from planar import OccupancyGrid, Pose2, Scan, grid_from_picture
from planar.deprecation import renamed_method
from planar.geometry.limits import MAX_COORDINATE, is_within
from planar.geometry.no_return import NoReturnDetector

# Share of the particles of a lost robot that is drawn at poses where the scan fits the map.
_RECOVERY_SHARE = 0.3
# Share that is drawn around the scan matching result if the scan fits and the robot is not lost: particles
# drawn by weight alone lag behind a constant odometry bias.
_MATCHED_SHARE = 0.1
# Distance from the last update from which on a scan is made at another place [m].
_ELSEWHERE = 0.1


@dataclass(frozen=True)
class Estimate:
    """An estimate of the robot's pose.

    Attributes:
        base_in_map: Mean of the cluster of largest weight, refined by scan matching with ``refine_pose``.
        covariance: Covariance (3, 3) of x, y, yaw over all particles [m^2, rad^2].
    """

    base_in_map: Pose2
    covariance: np.ndarray


class Localizer:
    """Adaptive Monte Carlo localization (Probabilistic Robotics, tables 8.2 to 8.4) with amcl's behaviour.

    Each update predicts the particles with the motion model, weights them with the sensor model, and
    resamples them with KLD-sampling; random particles are added while the short-term likelihood is below the
    long-term one. Updates happen only after the robot has moved; the first scan after a start is always used.

    Beyond amcl, the fit of each scan at the estimate is evaluated. While the robot is lost, particles are
    drawn at poses at which the scan fits the map.

    Args:
        grid: The map.
        settings: Parameters of the filter and of its models.
        rng: Source of all randomness.

    Raises:
        LocalizationError: If the map has no free cells.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings, rng: np.random.Generator):
        self._grid = grid
        self._rng = rng
        self._free_space = FreeSpace(grid)
        self._odom_in_map: Optional[Pose2] = None
        self._base_in_odom = Pose2()
        self._start_filter: Callable[[], None] = self._start_anywhere
        self._update_policy, self._updates = UpdatePolicy(), 0
        self._covariance = np.zeros((3, 3))
        self._quality: Optional[ScanQuality] = None
        self._no_return = NoReturnDetector()
        self._configure(settings)
        self.set_pose(InitialPose().pose, InitialPose().covariance)

    @property
    def settings(self) -> LocalizerSettings:
        return self._settings

    @property
    def particles(self) -> ParticleSet:
        return self._filter.particles

    @property
    def odom_in_map(self) -> Optional[Pose2]:
        """Pose of the odometry frame in the map; None before the first estimate."""
        return self._odom_in_map

    @property
    def belief(self) -> Optional[Belief]:
        """State from which another Localizer can resume; None before the first estimate after a start."""
        updated_at = self._update_policy.updated_at
        if self._updates == 0 or updated_at is None or self._odom_in_map is None:
            return None
        return Belief(self.particles, updated_at, self._odom_in_map, self.is_lost)

    @property
    def updates(self) -> int:
        """Number of updates since the last start."""
        return self._updates

    @property
    def quality(self) -> Optional[ScanQuality]:
        """Fit of the last scan at the estimate; None before the first estimate."""
        return self._quality

    @property
    def is_lost(self) -> bool:
        """Whether the scans contradict the estimate, or global localization has not converged yet."""
        return self._detector.is_lost

    @property
    def likelihood_grid(self) -> OccupancyGrid:
        """The likelihood field for display: 100 on obstacles, 0 far from them."""
        fits = np.rint(100.0 * self._likelihood.field.fit[1:-1, 1:-1]).astype(np.int8)
        return OccupancyGrid(fits, self._grid.resolution, self._grid.origin)

    def reconfigure(self, settings: LocalizerSettings) -> None:
        """Change the settings and restart the filter around the last estimate, as amcl does.

        Without an update since the last start, that start is repeated.
        """
        self._configure(settings)
        updated_at = self._update_policy.updated_at
        if self._updates > 0 and self._odom_in_map is not None:
            base_in_map, updated_at = self._odom_in_map @ self._base_in_odom, self._base_in_odom
            self._start_filter = partial(self._start_around, base_in_map, self._covariance)
        self._start_filter()
        self._update_policy = UpdatePolicy(updated_at)

    def set_pose(self, base_in_map: Pose2, pose_covariance: np.ndarray) -> None:
        """Restart the filter with a Gaussian distribution.

        Args:
            base_in_map: Mean pose.
            pose_covariance: Covariance (3, 3) of x, y, yaw [m^2, rad^2].

        Raises:
            LocalizationError: If a number is not finite or out of range.
        """
        if not is_valid_initial_pose(base_in_map, pose_covariance):
            raise LocalizationError("an initial pose and its covariance must be finite and within range")
        self._start_filter = partial(self._start_around, base_in_map, np.array(pose_covariance))
        self._start_filter()

    def restore(self, belief: Belief) -> None:
        """Resume from the state of another Localizer; odometry has continued since."""
        self._start_filter = partial(self._start_with, belief)
        self._start_filter()
        self._update_policy = UpdatePolicy(belief.base_in_odom)
        self._odom_in_map = belief.odom_in_map

    def start_global_localization(self) -> None:
        """Start global localization: distribute the particles uniformly over the free space."""
        self._start_filter = self._start_anywhere
        self._start_filter()

    def request_update(self) -> None:
        """Use the next scan for an update even if the robot has not moved."""
        self._update_policy.request()

    def update(self, base_in_odom: Pose2, scan: Scan, laser: str = "") -> Optional[Estimate]:
        """Process a scan.

        Args:
            base_in_odom: Odometry pose at the stamp of the scan.
            scan: The scan, with the pose of the laser in the base frame.
            laser: Name of the laser; each laser has its own update condition.

        Returns:
            The new estimate, or None if the scan does not lead to one.

        Raises:
            LocalizationError: If the odometry or the limits of the scan are invalid.
        """
        if not base_in_odom.is_in_range():
            raise LocalizationError("the odometry pose is not finite or out of range")
        scan = scan if self._settings.strict_compat else self._no_return.limited(scan)
        beams = evenly_spaced_beams(scan, self._settings)
        self._base_in_odom = base_in_odom
        estimate = None
        if self._update_policy.is_due(base_in_odom, laser, scan.stamp, self._settings):
            self._learn_no_return(base_in_odom, scan)
            self._move(base_in_odom)  # first: a motion whose prediction fails is repeated with the next scan
            self._update_policy.record_update(base_in_odom, laser)
            self._weigh(beams)
            is_resampled = self._resample_if_due(beams)
            if is_resampled or self._updates == 1:
                estimate = self._estimate(base_in_odom, scan, beams)
        self._evaluate_fit(base_in_odom, beams, scan.stamp)
        return estimate

    go_on = renamed_method("go_on", "restore")
    scatter = renamed_method("scatter", "start_global_localization")

    def _configure(self, settings: LocalizerSettings) -> None:
        likelihood, motion = ScanLikelihood(self._grid, settings), motion_model_of(settings)
        self._settings, self._likelihood, self._motion = settings, likelihood, motion
        self._search = PoseSearch(likelihood.field, self._grid)

    def _start_around(self, base_in_map: Pose2, covariance: np.ndarray) -> None:
        count = self._settings.max_particles
        self._start(gaussian_particles(base_in_map, covariance, count, self._rng), is_lost=False)

    def _start_with(self, belief: Belief) -> None:
        particles, settings = belief.particles, self._settings
        if not settings.min_particles <= particles.size <= settings.max_particles:
            drawn = self._rng.choice(particles.size, settings.max_particles, p=particles.weights)
            particles = equally_weighted(particles.poses[drawn])
        self._start(particles, belief.is_lost)

    def _start_anywhere(self) -> None:
        poses = self._free_space.draw(self._settings.max_particles, self._rng)
        self._start(equally_weighted(poses), is_lost=True)

    def _start(self, particles: ParticleSet, is_lost: bool) -> None:
        self._filter = ParticleFilter(particles, self._rng)
        self._detector = LostDetector(is_lost)
        self._update_policy = UpdatePolicy()
        self._updates = 0
        self._matched_spread: Optional[np.ndarray] = None
        self._last_estimate: Optional[LastEstimate] = None
        # The last estimate, if it was confirmed or continues a confirmed one.
        self._track: Optional[LastEstimate] = None

    def _learn_no_return(self, base_in_odom: Pose2, scan: Scan) -> None:
        """Learn from scans made at different places, between which no wall stays at the same distance."""
        base_before = self._update_policy.updated_at
        if base_before is None or base_before.distance_to(base_in_odom) > _ELSEWHERE:
            self._no_return.add(scan.ranges)

    def _move(self, base_now: Pose2) -> None:
        base_before = self._update_policy.updated_at
        if base_before is not None and base_now != base_before:
            self._filter.move(base_before, base_now, self._motion)

    def _weigh(self, beams: Beams) -> None:
        if self._settings.beams >= 2:
            poses, has_converged = self._filter.particles.poses, self._filter.has_converged
            self._filter.weigh(self._likelihood.log_likelihoods(poses, beams, has_converged), self._settings)
        self._updates += 1

    def _resample_if_due(self, beams: Beams) -> bool:
        """Resample every ``resample_interval`` updates."""
        is_due = self._updates % self._settings.resample_interval == 0
        if is_due and self._filter.should_resample(self._settings):
            self._filter.resample(self._settings, *self._injected_poses(beams))
        return is_due

    def _injected_poses(self, beams: Beams) -> Tuple[float, DrawPoses]:
        """Return the share of injected particles and their distribution (augmented and mixture MCL)."""
        if self._settings.recover_when_lost and self.is_lost:
            places = find_hypotheses(beams, self._likelihood.field, self._grid, self._free_space, self._rng)
            if len(places) > 0:
                return _RECOVERY_SHARE, places.draw
        drop, spread = self._filter.likelihood_drop(), self._matched_spread
        confirms_pose = self._quality is not None and self._quality.confirms_pose
        if drop == 0.0 and confirms_pose and self._odom_in_map is not None and spread is not None:
            return _MATCHED_SHARE, partial(gaussian_poses, self._odom_in_map @ self._base_in_odom, spread)
        return drop, self._free_space.draw

    def _estimate(self, base_in_odom: Pose2, scan: Scan, beams: Beams) -> Estimate:
        cluster = best_cluster(self.particles)
        base_in_map, covariance = mean_and_covariance(cluster)
        if self._settings.refine_pose:
            ends_xy = all_beams(scan, self._settings).ends_xy
            base_in_map = match_scan(base_in_map, covariance, ends_xy, self._likelihood.field)
            if self._search.needs_search(base_in_map, base_in_odom, beams, self._track):
                base_in_map = self._searched(base_in_map, cluster, base_in_odom, ends_xy, beams)
            self._matched_spread = covariance
        if cluster is not self.particles:
            _, covariance = mean_and_covariance(self.particles)
        self._odom_in_map = base_in_map @ base_in_odom.inverse()
        self._last_estimate = LastEstimate(self._odom_in_map, base_in_odom)
        self._track = self._track and self._last_estimate
        self._covariance = covariance
        return Estimate(base_in_map, self._covariance)

    def _searched(
        self, found: Pose2, cluster: ParticleSet, base_in_odom: Pose2, ends_xy: np.ndarray, beams: Beams
    ) -> Pose2:
        """Search for the pose around the tracked one, or around the particles if there is none."""
        proposals, predicted = cluster.poses, None
        if self._track is not None:
            proposals = self._track.proposals(base_in_odom, self._motion, self._rng)
            predicted = self._track.predicted(base_in_odom)
        return self._search.best_match(found, cluster.poses, proposals, predicted, ends_xy, beams)

    def _evaluate_fit(self, base_in_odom: Pose2, beams: Beams, stamp: float) -> None:
        if self._odom_in_map is None:
            return
        base_in_map = self._odom_in_map @ base_in_odom
        self._quality = self._search.quality(base_in_map, beams)
        self._detector.add(self._quality, stamp)
        if self._quality.confirms_pose and not self.is_lost:
            self._track = self._last_estimate
        if self._settings.recover_when_lost and self._quality.contradicts_pose:
            self._update_policy.request()  # otherwise a robot at rest would never recover


def is_valid_initial_pose(base_in_map: Pose2, covariance: np.ndarray) -> bool:
    """Check that a pose and its covariance (3, 3) are finite and within range."""
    return base_in_map.is_in_range() and is_within(MAX_COORDINATE, *np.ravel(covariance))


def warm_up(settings: LocalizerSettings) -> None:
    """Compile the kernels of an update, or load them from the cache, before the first scan."""
    grid = grid_from_picture("####\n#..#\n####")
    scan = Scan(0.0, -1.0, 0.5, np.full(5, 0.5, dtype=np.float32), 0.1, 2.0)
    localizer = Localizer(grid, settings, np.random.default_rng(0))
    localizer.start_global_localization()
    for step in range(settings.resample_interval):
        localizer.request_update()
        localizer.update(Pose2(0.01 * step, 0.0, 0.0), scan)
