"""Contract of recovery behaviours (nav_core: RecoveryBehavior).

Life cycle: an object is one run of a behaviour. It is constructed with its settings when its turn comes;
``RecoveryBehavior.step`` is called once a control period until it returns None; then the object is
dropped. A cancelled or new goal drops it at once, without another call.

To add a behaviour to this package, write a module with settings, a class and its Plugin, and add it to
``recovery/registry.py``. ``test/test_recovery.py`` checks the contract.
"""

import math
from dataclasses import dataclass
from typing import Any, Callable, Optional, Protocol

from move_base_lite.costmap import LayeredCostmap
from move_base_lite.errors import NavigationError, PluginFailed
from planar import Pose2, Twist2
from planar.extensions import MAX_CALL_SECONDS, ExtensionPoint, InvalidAnswer


@dataclass(frozen=True)
class RecoverySettings:
    """Base class of the settings of a recovery behaviour; it has no parameters."""


@dataclass(frozen=True)
class SpeedLimit:
    """A temporary speed limit.

    Attributes:
        highest: Highest speeds [m/s, rad/s].
        distance: Distance after which the limit ends [m].
    """

    highest: Twist2
    distance: float


@dataclass(frozen=True)
class RecoveryContext:
    """Robot state and costmaps for a recovery behaviour.

    Attributes:
        base_in_map: Robot pose in the map frame.
        base_in_local: Robot pose in the frame of the local costmap.
        twist: Velocity of the robot.
        period: Control period [s].
        global_costmap: Costmap for planning, which the behaviour may clear.
        local_costmap: Costmap for control, which the behaviour may clear.
        limit_speed: Sets a temporary speed limit for the local planner.
    """

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    period: float
    global_costmap: LayeredCostmap
    local_costmap: LayeredCostmap
    limit_speed: Callable[[SpeedLimit], None]


class RecoveryBehavior(Protocol):
    """A recovery behaviour; constructed with its settings."""

    def __init__(self, settings: Any): ...

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """Run one control period.

        The behaviour must not collide: its commands are not checked against the costmap.

        Args:
            context: Robot state and costmaps.

        Returns:
            The velocity command for this period; None when the behaviour has finished.
        """
        ...


def _checked(command: Optional[Twist2], context: RecoveryContext) -> Optional[Twist2]:
    if command is not None and not (math.isfinite(command.v) and math.isfinite(command.omega)):
        raise InvalidAnswer(f"asked for {command.v} m/s, {command.omega} rad/s")
    return command


CONTRACT: ExtensionPoint[RecoveryBehavior] = ExtensionPoint(
    "recovery behaviour",
    RecoveryBehavior,
    "move_base_lite.recovery_behaviors",
    PluginFailed,
    passes=(NavigationError,),
    answers={"step": _checked},
    writable=frozenset({"context"}),
    max_seconds=MAX_CALL_SECONDS,
    is_lazy=True,
    settings=RecoverySettings,
)


@dataclass(frozen=True)
class NamedRecovery:
    """An entry of ~recovery_behaviors.

    Attributes:
        name: Its name in the list.
        settings: Its parameters; their type selects the behaviour.
    """

    name: str
    settings: Any
