"""The contract of a task.

A task is a frozen dataclass of its own file, with a function that reads it from a scenario's table ``task``,
and one line of the registry.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Mapping, Optional, Protocol, Sequence, Tuple

import numpy as np

from laboratory.worlds.source import Arena
from planar import Pose2

if TYPE_CHECKING:
    from laboratory.scenario.scenario import Scenario

SUCCESS, FAILURE, COLLISION, TIMEOUT, ERROR = OUTCOMES = (
    "success",
    "failure",
    "collision",
    "timeout",
    "error",
)


@dataclass(frozen=True, eq=False)
class RunTrace:
    """How a run went.

    ``trajectory``: (N, 4) stamp, true x, y, yaw. ``localization_error``: (M,), metres, of a robot with a map.
    ``touched``: names of what it bumped into. ``way``: metres of the shortest way there is.
    ``score``: that of a benchmark. ``people``: (N, P, 5), and who of them ``ran_into_robot``: of
    home_service.judging.pedestrian_contacts.
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


class Task(Protocol):
    """Something to do in an arena; the same scenario and seed are played alike, to the last bit."""

    def run(self, scenario: "Scenario", arena: Arena, seed: int) -> RunTrace:
        """Plays it. Raises PlanarError if that is impossible."""

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        """Where the robot must be able to stand."""

    def reference_length(self, scenario: "Scenario", arena: Arena) -> Optional[float]:
        """Metres of the shortest way that does it, if that is known."""

    def files(self) -> Tuple[Path, ...]:
        """What the task is read from."""

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Path]:
        """The task as the launch files' ``zones_file`` and, if it is a mission, ``mission_file``.

        What is not there yet is written into ``folder``. Raises PlanarError if nodes cannot play it.
        """
