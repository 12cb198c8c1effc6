"""Contract of a kind of fault: what it changes of scans, odometry, commands, wheels, or the environment.

A kind is a class derived from ``FaultKind`` and one line of the registry, or a user-defined class that is
chosen by its dotted name. Each fault of a run gets its own instance, with its strength and random generator,
which may keep state. Its methods are called only while the fault is active.
"""

import math
from dataclasses import dataclass
from typing import Any, ClassVar, Iterable, Optional, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from planar.deprecation import deprecated_names
from planar.extensions import ExtensionPoint, InvalidAnswer
from sim_bridge.errors import FaultError
from sim_bridge.scene import Scene
from sim_bridge.sensors.odometry import Odometry

__getattr__ = deprecated_names(__name__, {"Stage": "FaultContext"})


@dataclass(frozen=True)
class Fault:
    """A fault of a run.

    Attributes:
        kind: Name of the kind.
        start: Time at which it becomes active [simulated s].
        end: Time at which it ends [simulated s].
        strength: In the unit of its kind.
        seed: Seed of its random numbers.
    """

    kind: str
    start: float = 0.0
    end: float = float("inf")
    strength: float = 0.0
    seed: int = 0


@dataclass(frozen=True, eq=False)
class FaultContext:
    """The part of the simulation that a fault of the environment may change.

    Attributes:
        scene: The simulated world.
        robot: Name of the robot's model.
        base_in_world: True pose of the robot's base.
    """

    scene: Scene
    robot: str
    base_in_world: Pose2


class FaultKind:
    """Base class of faults; a subclass overrides the methods for what it changes.

    The first line of the subclass's docstring states the effect; tables and the cockpit show it.

    Args:
        strength: Strength of the fault, in ``unit``; an instance finds it in ``self._strength``.
        rng: Random generator of the fault; an instance finds it in ``self._rng``.

    Attributes:
        strength: Default, least and largest strength.
        unit: Unit of the strength.
        survivable: Whether the mission can succeed in spite of the fault.
    """

    strength: ClassVar[Tuple[float, float, float]] = (1.0, 0.0, 1.0)
    unit: ClassVar[str] = ""
    survivable: ClassVar[bool] = True

    def __init__(self, strength: float, rng: np.random.Generator):
        self._strength, self._rng = strength, rng

    def scan(self, scan: Scan) -> Optional[Scan]:
        """Change a scan before it is published.

        Args:
            scan: What the laser has measured; must not be changed in place.

        Returns:
            The scan to publish instead; None for none.
        """
        return scan

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        """Change an odometry estimate before it is published.

        Args:
            odometry: Pose in the odometry frame and velocity in the base frame.

        Returns:
            The estimate to publish instead; None for none.
        """
        return odometry

    def command(self, twist: Twist2) -> Optional[Twist2]:
        """Change a velocity command before the drive receives it.

        Args:
            twist: The command: speed [m/s] and turn rate [rad/s].

        Returns:
            The command that the drive receives instead; None for none.
        """
        return twist

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        """Change the speeds that the drive sets.

        Args:
            left: Target speed of the left wheels [rad/s].
            right: Target speed of the right wheels [rad/s].

        Returns:
            Speeds at which the left and the right wheels turn instead [rad/s].
        """
        return left, right

    def begin(self, context: FaultContext) -> None:
        """Change the environment when the fault starts.

        Args:
            context: The scene, and the robot with its true pose.
        """

    def end(self, context: FaultContext) -> None:
        """Undo the change when the fault ends.

        Args:
            context: The scene, and the robot with its true pose.
        """


def _requirements(found: Any) -> Iterable[str]:
    if not issubclass(found, FaultKind):
        yield f"it is not derived from {FaultKind.__module__}.FaultKind"
        return
    try:
        default, least, largest = map(float, found.strength)
        is_valid = least <= default <= largest
    except (TypeError, ValueError):
        is_valid = False
    if not is_valid:
        yield f"strength must be (default, least, largest), got {found.strength!r}"


def _checked(method: str, expected: type) -> Any:
    def check(changed: Any, given: Any) -> Any:
        if changed is not None and not isinstance(changed, expected):
            got = type(changed).__name__
            raise InvalidAnswer(f"{method} returned {got}, expected {expected.__name__} or None")
        return changed

    return check


def _checked_speeds(changed: Any, left: float, right: float) -> Tuple[float, float]:
    try:
        speeds = float(changed[0]), float(changed[1])
    except (TypeError, ValueError, IndexError):
        speeds = math.nan, math.nan
    if not all(map(math.isfinite, speeds)):
        raise InvalidAnswer(f"wheel_speeds returned {changed!r}, expected two finite numbers")
    return speeds


CONTRACT: ExtensionPoint[FaultKind] = ExtensionPoint(
    "fault",
    FaultKind,
    "sim_bridge.faults",
    FaultError,
    answers={
        "scan": _checked("scan", Scan),
        "odometry": _checked("odometry", Odometry),
        "command": _checked("command", Twist2),
        "wheel_speeds": _checked_speeds,
    },
    writable=frozenset({"context"}),
    requirements=_requirements,
)
