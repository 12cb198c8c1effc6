"""Contract of a task.

A task is a frozen dataclass in a module of this folder, with a function that reads it from the table ``task``
of a scenario and an entry in laboratory.scenario.registry.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping, Optional, Protocol, Sequence, Tuple

import numpy as np

from laboratory.worlds.source import Arena
from planar import Pose2
from sim_bridge import SimulationSettings
from sim_bridge.faults import Fault

SUCCESS, FAILURE, COLLISION, TIMEOUT, ERROR = OUTCOMES = (
    "success",
    "failure",
    "collision",
    "timeout",
    "error",
)


@dataclass(frozen=True, eq=False)
class RunTrace:
    """Recorded data of one run.

    Attributes:
        outcome: One of ``OUTCOMES``.
        reason: Why the run ended so.
        trajectory: (N, 4) stamp, true x, y, yaw.
        localization_error: (M,) distances between estimated and true position [m]; empty without a map.
        collisions: Names of the bodies the robot collided with.
        reference_length: Length of the shortest path [m].
        score: Score of the benchmark.
        people: (N, P, 5) pedestrians as in ``evaluation.pedestrian_contacts``.
        people_at_fault: Names of the pedestrians who touched the robot by their own fault.
    """

    outcome: str
    reason: str
    trajectory: np.ndarray
    localization_error: np.ndarray
    collisions: Sequence[str] = ()
    reference_length: Optional[float] = None
    score: Optional[float] = None
    people: np.ndarray = field(default_factory=lambda: np.empty((0, 0, 5)))
    people_at_fault: Sequence[str] = ()


class RunConditions(Protocol):
    """What a task uses of its Scenario; see there."""

    @property
    def robot(self) -> str: ...

    @property
    def start(self) -> Pose2: ...

    @property
    def simulation(self) -> SimulationSettings: ...

    @property
    def faults(self) -> Tuple[Fault, ...]: ...

    @property
    def planner(self) -> str: ...

    @property
    def parameters(self) -> Mapping[str, Any]: ...

    @property
    def seconds(self) -> float: ...


def outcome_of(success: bool, collisions: Sequence[str], simulated_seconds: float, limit: float) -> str:
    """Return the outcome of a mission.

    Args:
        success: Whether the verdict is a success.
        collisions: What the robot collided with.
        simulated_seconds: Duration of the run [s].
        limit: Time limit [s].
    """
    if success:
        return SUCCESS
    if collisions:
        return COLLISION
    return TIMEOUT if simulated_seconds > limit else FAILURE


class Task(Protocol):
    """A task in an arena. Runs with equal scenario and seed are equal to the last bit."""

    def run(self, scenario: RunConditions, arena: Arena, seed: int) -> RunTrace:
        """Run the task. Raises PlanarError if that is impossible."""

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        """Return poses in the world frame that must stay free of boxes and reachable."""

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        """Return the length of the shortest path that completes the task [m], if known."""

    def files(self) -> Tuple[Path, ...]:
        """Return the files the task is read from."""

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Any]:
        """Return the arguments of the launch file that concern the task, such as ``zones_file``.

        Files that do not exist yet are written into ``folder``.

        Raises:
            PlanarError: The task cannot be run over ROS.
        """
