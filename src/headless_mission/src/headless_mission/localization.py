"""Localization in an episode: the estimate of a control period is available from the next one on."""

from contextlib import suppress
from functools import lru_cache
from typing import Callable, List

import numpy as np

from amcl_lite import Localizer
from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.errors import LocalizationError
from evaluation.presets import LOCALIZATION_CONFIG
from headless_mission.encoding import Encoding, ExactValues
from move_base_lite import PoseHistory
from planar import OccupancyGrid, Pose2, Scan
from planar.config.parameters import settings_from_yaml
from sim_bridge import Episode, EpisodeHooks, StepResult


class LocalizationHooks(EpisodeHooks):
    """Localizes the robot by its scans.

    Args:
        grid: Map.
        seed: Seed of the particles.
        start: Initial estimate.
        poses: Poses from odometry, which receive the estimate.
        on_fit: Called with the time and the fit of each scan.
        encoding: Precision of scans and estimates.
    """

    def __init__(
        self,
        grid: OccupancyGrid,
        seed: int,
        start: Pose2,
        poses: PoseHistory,
        on_fit: Callable[[float, float], None] = lambda stamp, fit: None,
        encoding: Encoding = ExactValues(),
    ):
        self._settings = _settings()
        self._localizer = Localizer(grid, self._settings, np.random.default_rng(seed))
        if start != Pose2():
            self._localizer.set_pose(start, InitialPose().covariance)
        self._poses, self._on_fit, self._encoding = poses, on_fit, encoding
        self._valid_until = 0.0
        self._fits: List[float] = []

    def after_step(self, episode: Episode, step: StepResult) -> None:
        scan = step.scan
        if scan is not None:
            with suppress(LocalizationError):  # the node logs it and continues, too
                self._localize(self._encoding.scan(scan))

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Publish the estimate: it takes effect at the next tick."""
        odom_in_map = self._localizer.odom_in_map
        if odom_in_map is not None:
            self._poses.set_odom_in_map(self._encoding.pose(odom_in_map), self._valid_until)
        for fit in self._fits:
            self._on_fit(step.stamp, fit)
        self._fits.clear()

    def _localize(self, scan: Scan) -> None:
        base_in_odom = self._poses.base_in_odom(scan.stamp)
        if base_in_odom is None:
            return
        self._localizer.update(base_in_odom, scan)
        self._valid_until = scan.stamp + self._settings.transform_tolerance
        if self._localizer.quality is not None:
            self._fits.append(self._localizer.quality.probability)


@lru_cache(maxsize=1)
def _settings() -> NodeSettings:
    """Read the settings once a process."""
    return settings_from_yaml(NodeSettings, LOCALIZATION_CONFIG)[0]
