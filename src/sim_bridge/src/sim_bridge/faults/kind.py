"""The contract of a kind of fault: what it changes of a scan, of odometry, of a drive, or of the home.

A kind is a class of its own file, and one line of the registry. It is made anew for each fault of a run, with
the fault's strength and random numbers, and may keep what it needs in mind. Only while its fault lasts is it
asked.
"""

from dataclasses import dataclass
from typing import ClassVar, Optional, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from sim_bridge.scene import Scene
from sim_bridge.sensors.odometry import Odometry


@dataclass(frozen=True)
class Fault:
    """Something that goes wrong from ``start`` to ``end``, seconds of simulated time.

    ``strength``: in the unit of its kind. ``seed``: of what is random about it.
    """

    kind: str
    start: float = 0.0
    end: float = float("inf")
    strength: float = 0.0
    seed: int = 0


@dataclass(frozen=True, eq=False)
class Stage:
    """What a fault of the home can reach: the world, the robot's name in it, and where that truly is."""

    scene: Scene
    robot: str
    base_in_world: Pose2


class FaultKind:
    """``strength``: the usual one, its least and its largest; ``unit``: of it; ``survivable``: whether the
    mission can be done all the same. The class's docstring says in a line what goes wrong.
    """

    strength: ClassVar[Tuple[float, float, float]] = (1.0, 0.0, 1.0)
    unit: ClassVar[str] = ""
    survivable: ClassVar[bool] = True

    def __init__(self, strength: float, rng: np.random.Generator):
        self._strength, self._rng = strength, rng

    def scan(self, scan: Scan) -> Optional[Scan]:
        """What the laser tells instead of ``scan``; None: nothing."""
        return scan

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        """What odometry tells instead; None: nothing."""
        return odometry

    def command(self, twist: Twist2) -> Optional[Twist2]:
        """What the drive hears instead of a command; None: nothing."""
        return twist

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        """What the wheels turn at instead, rad/s."""
        return left, right

    def begin(self, stage: Stage) -> None:
        """The fault has begun."""

    def end(self, stage: Stage) -> None:
        """It is over."""
