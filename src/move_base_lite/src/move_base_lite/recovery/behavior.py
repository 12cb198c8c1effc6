"""The contract of recovery behaviours: what the robot tries when it finds no plan or no safe velocity.

Life cycle. An object is one run of a behaviour: it is made with its settings when its turn comes, has
:meth:`~RecoveryBehavior.step` called once a control period until it says that it has ended, and is thrown
away; a goal that is cancelled, or another one, ends it at once, without a word.

To add one: a file with settings, a class and its Plugin, and a line in ``recovery/registry.py``.
``test/test_recovery.py`` holds it to what is said here.
"""

from dataclasses import dataclass
from typing import Any, Callable, Optional, Protocol

from move_base_lite.costmap import LayeredCostmap
from planar import Pose2, Twist2


@dataclass(frozen=True)
class RecoverySettings:
    """What every behaviour can be told: nothing."""


@dataclass(frozen=True)
class SpeedLimit:
    """How fast the robot may go until it has moved ``distance`` metres."""

    highest: Twist2
    distance: float


@dataclass(frozen=True)
class RecoveryContext:
    """What a behaviour may look at and change; ``limit_speed`` tells the robot to go slowly for a while."""

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    period: float
    global_costmap: LayeredCostmap
    local_costmap: LayeredCostmap
    limit_speed: Callable[[SpeedLimit], None]


class RecoveryBehavior(Protocol):
    """Made by ``make(settings)``."""

    def __init__(self, settings: Any): ...

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """The velocity for this period; None when the behaviour has ended, and the robot stands.

        It has to stop by itself before it touches anything: nobody else looks.
        """
        ...


@dataclass(frozen=True)
class NamedRecovery:
    """A behaviour in the list of those to try: the name it is given there, and its settings."""

    name: str
    settings: Any
