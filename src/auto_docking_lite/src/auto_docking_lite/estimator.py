"""Estimates the pose of a dock from its infrared signals: a particle filter over the pose of the dock.

The robot's odometry moves the receivers; each signal states in which fan, at which range and within which
receiver's opening angle the dock is (Probabilistic Robotics, chapter 4.3).
"""

import math
from typing import NamedTuple, Optional, Sequence, Tuple

import numpy as np

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.kernels import log_likelihoods
from planar import Pose2, wrap
from planar.geometry.dock_field import CENTRE, FAR_CENTRE, LEFT, NEAR, RIGHT
from planar.geometry.pose import cos_sin

Signals = Tuple[int, int, int]
# Numbers of particles: with a position that is known better than within SPREAD [m], and before.
PARTICLES, FIRST_PARTICLES, SPREAD = 400, 2000, 0.1
# Width of the resampling kernel relative to the particles' spread, and its least deviations [m, m, rad].
KERNEL, LEAST_KERNEL = 0.3, (0.002, 0.002, 0.004)
# Share of effective particles below which they are resampled between two signals.
LEAST_EFFECTIVE = 0.5
# Motion of the robot between two signals that are used, unless they differ [m, rad].
MIN_DISTANCE, MIN_ANGLE = 0.01, 0.035
# Growth of the uncertainty: per metre [m, rad] and per radian [m, rad].
DRIFT_BY_DISTANCE, DRIFT_BY_ANGLE = (0.02, 0.02), (0.005, 0.02)
# Mean log-likelihood of signals below which the estimate contradicts them, and how many in a row it may.
CONTRADICTION, MAX_CONTRADICTIONS = -2.0, 8
YAW_DEVIATION = 0.3


class DockEstimate(NamedTuple):
    """Pose of a dock with its uncertainty.

    Attributes:
        dock_in_odom: Mean.
        position_deviation: Standard deviation of the position [m].
        yaw_deviation: Standard deviation of the heading [rad].
    """

    dock_in_odom: Pose2
    position_deviation: float
    yaw_deviation: float


class DockEstimator:
    """A particle filter over the pose of a dock in the odometry frame.

    Args:
        settings: Expected geometry of the field.
        rng: Random generator.

    Attributes:
        has_signal: Whether a signal has been received since the start or since the last contradiction.
        contradictions: Number of signals in a row that contradict the estimate.
    """

    def __init__(self, settings: DockingSettings, rng: np.random.Generator):
        self._settings, self._rng = settings, rng
        self._field = np.array(
            (
                settings.dock_centre_half_angle,
                settings.dock_side_half_angle,
                settings.dock_near_range,
                settings.dock_far_range,
                settings.dock_receiver_bearing,
                settings.dock_receiver_half_angle,
                settings.dock_receiver_radius,
            )
        )
        self._particles: Optional[np.ndarray] = None
        self._last: Optional[Tuple[Pose2, Signals]] = None
        self.has_signal, self.contradictions = False, 0

    def expect(self, dock_in_odom: Pose2) -> None:
        """Start from a known dock, which may have been moved.

        Args:
            dock_in_odom: Its pose.
        """
        spread = self._settings.prior_deviation
        noise = self._rng.normal(size=(FIRST_PARTICLES, 3)) * (spread, spread, YAW_DEVIATION / 2.0)
        self._particles = dock_in_odom.as_array() + noise
        self.has_signal = False

    def estimate(self) -> Optional[DockEstimate]:
        """Return the estimate; None without a known dock and before the first signal."""
        if self._particles is None:
            return None
        x, y, yaw = self._particles.T
        cosine, sine = (float(each.mean()) for each in cos_sin(yaw))
        mean = Pose2(float(x.mean()), float(y.mean()), math.atan2(sine, cosine))
        length = min(max(math.hypot(sine, cosine), 1e-9), 1.0)
        return DockEstimate(mean, float(math.hypot(x.std(), y.std())), math.sqrt(-2.0 * math.log(length)))

    def update(self, received: Sequence[Tuple[Pose2, Signals]]) -> None:
        """Update the estimate.

        Before the first signal the estimate stays where a dock is expected: one that is hidden or gone would
        otherwise be moved to wherever no signal is received.

        Args:
            received: Poses of the robot in odom with the signals received there, in the order of time.
        """
        used = [each for each in received if self._is_news(*each)]
        if not used:
            return
        number = next((i for i, (_, signals) in enumerate(used) if any(signals)), None)
        if number is not None:
            self.has_signal = True
            if self._particles is None:
                self._particles = self._around(*used[number])
        if self._particles is not None and self.has_signal:
            count = sum(bool(bits) for _, signals in used for bits in signals)
            self._check(self._condition(used), count, used)

    def _condition(self, used: Sequence[Tuple[Pose2, Signals]]) -> float:
        """Condition the particles on signals and return the log-likelihood of the best ones.

        Several signals at once would leave few of the particles, so that they are resampled in between.
        """
        assert self._particles is not None
        best, logs = 0.0, np.zeros(len(self._particles))
        for number, (base, signals) in enumerate(used):
            bases, signal = base.as_array()[None], np.array(signals, dtype=np.int64)[None]
            logs = logs + log_likelihoods(self._particles, bases, signal, self._field)
            weights = np.exp(logs - logs.max())
            weights /= weights.sum()
            is_last, effective = number == len(used) - 1, 1.0 / (weights**2).sum()
            if is_last or effective < LEAST_EFFECTIVE * len(weights):
                best += float(logs.max())
                self._resample(weights)
                logs = np.zeros(len(self._particles))
        return best

    def _is_news(self, base: Pose2, signals: Signals) -> bool:
        """Return whether a signal adds information; if so, let the particles drift by the motion."""
        last = self._last
        if last is not None:
            distance, angle = last[0].distance_to(base), abs(wrap(base.yaw - last[0].yaw))
            if last[1] == signals and distance < MIN_DISTANCE and angle < MIN_ANGLE:
                return False
            self._drift(distance, angle)
        self._last = (base, signals)
        return True

    def _drift(self, distance: float, angle: float) -> None:
        if self._particles is None:
            return
        by_distance, by_angle = DRIFT_BY_DISTANCE, DRIFT_BY_ANGLE
        position, yaw = (by_distance[i] * distance + by_angle[i] * angle for i in (0, 1))
        scale = np.array((position, position, yaw))
        self._particles = self._particles + self._rng.normal(size=self._particles.shape) * scale

    def _check(self, best: float, count: int, used: Sequence[Tuple[Pose2, Signals]]) -> None:
        """Count contradictions, and start afresh from the signals after too many in a row."""
        if count == 0:
            return
        self.contradictions = self.contradictions + 1 if best < CONTRADICTION * count else 0
        if self.contradictions > MAX_CONTRADICTIONS:
            self.contradictions = 0
            seen = [each for each in used if any(each[1])]
            self._particles = self._around(*seen[-1])

    def _resample(self, weights: np.ndarray) -> None:
        """Low-variance resampling (Probabilistic Robotics, table 4.4); a kernel then keeps the covariance.

        Source of the kernel: Liu and West, Combined parameter and state estimation in simulation-based
        filtering, 2001; here by differences of particles, in which position and heading are correlated.
        """
        assert self._particles is not None
        mean = weights @ self._particles
        variance = weights @ (self._particles - mean) ** 2
        count = PARTICLES if variance[0] + variance[1] < SPREAD**2 else FIRST_PARTICLES
        positions = (np.arange(count) + self._rng.random()) / count
        chosen = np.minimum(np.searchsorted(np.cumsum(weights), positions), len(weights) - 1)
        particles = self._particles[chosen]
        differences = self._rng.permutation(particles) - self._rng.permutation(particles)
        mean, kept = particles.mean(axis=0), math.sqrt(1.0 - KERNEL**2)
        noise = self._rng.normal(size=particles.shape) * LEAST_KERNEL
        self._particles = mean + kept * (particles - mean) + KERNEL * math.sqrt(0.5) * differences + noise

    def _around(self, base: Pose2, signals: Signals) -> np.ndarray:
        """Return poses (FIRST_PARTICLES, 3) of docks that explain the strongest signal received at a pose."""
        settings, rng, count = self._settings, self._rng, FIRST_PARTICLES
        number = max(range(3), key=lambda each: (bool(signals[each]), bool(signals[each] & CENTRE)))
        receiver, byte = list(settings.receivers(base))[number], signals[number]
        near = bool(byte & NEAR)
        low, high = (
            (0.0, settings.dock_near_range) if near else (settings.dock_near_range, settings.dock_far_range)
        )
        distance = rng.uniform(low, high, count)
        edge, limit = settings.dock_centre_half_angle, settings.dock_side_half_angle
        angle = rng.uniform(-edge, edge, count)
        if not byte & CENTRE:
            sides = [side for side, fan in ((1.0, LEFT), (-1.0, RIGHT)) if byte & fan]
            angle = rng.choice(sides, count) * rng.uniform(edge, limit, count)
        opening = settings.dock_receiver_half_angle
        to_dock = receiver.yaw + rng.uniform(-opening, opening, count)
        x, y = receiver.x + distance * np.cos(to_dock), receiver.y + distance * np.sin(to_dock)
        return np.column_stack((x, y, to_dock + math.pi - angle))


def warm_up() -> None:
    """Compile the kernel, or load it from the cache, before the first signal needs it."""
    DockEstimator(DockingSettings(), np.random.default_rng(0)).update([(Pose2(), (0, FAR_CENTRE, 0))])
