"""Outcome of an episode."""

import hashlib
from dataclasses import dataclass, field
from typing import Sequence

import numpy as np

from evaluation.verdict import MissionRecord, Verdict


@dataclass(frozen=True, eq=False)
class EpisodeResult:
    """Outcome of an episode.

    Attributes:
        verdict: Whether the mission succeeded, judged by ground truth.
        mission_record: Deliveries, collisions and markers that the verdict is based on.
        trajectory: (N, 4), stamp [s] and true x, y, yaw of the base in the world at each control period.
        localization_error: (N,), distance between estimated and true position [m].
        wall_seconds: Wall-clock time of the episode [s].
        diagnosis: First sensor that was found implausible, and why; empty if none.
        people: (N, P, 5), x, y, velocity in x and y, radius of each of P pedestrians.
        people_at_fault: Pedestrians that walked into the robot (evaluation.pedestrian_contacts).
    """

    verdict: Verdict
    mission_record: MissionRecord
    trajectory: np.ndarray
    localization_error: np.ndarray
    wall_seconds: float
    diagnosis: str = ""
    people: np.ndarray = field(default_factory=lambda: np.empty((0, 0, 5)))
    people_at_fault: Sequence[str] = ()

    @property
    def simulated_seconds(self) -> float:
        return float(self.trajectory[-1, 0])

    @property
    def real_time_factor(self) -> float:
        return self.simulated_seconds / self.wall_seconds

    @property
    def distance_driven(self) -> float:
        steps = np.diff(self.trajectory[:, 1:3], axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    @property
    def trajectory_hash(self) -> str:
        """SHA-256 of the true trajectory: equal for two episodes only if they agree to the last bit."""
        return hashlib.sha256(np.ascontiguousarray(self.trajectory).tobytes()).hexdigest()
