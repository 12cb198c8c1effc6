"""Recovery behaviours, one step a control period, so that each can be cancelled at any time."""

import math
from dataclasses import dataclass, field
from typing import Optional

from move_base_lite.costmap import LayeredCostmap
from planar import Pose2, SettingsError, Twist2, wrap
from planar.settings import check

LOOKAHEAD_ANGLE = 0.4


@dataclass(frozen=True)
class RotateSettings:
    """Rad/s and rad/s^2; read from TrajectoryPlannerROS, as rotate_recovery does."""

    acc_lim_theta: float = 3.2
    max_vel_theta: float = 1.0
    min_in_place_vel_theta: float = 0.4
    yaw_goal_tolerance: float = 0.1

    def __post_init__(self):
        check(self.acc_lim_theta > 0.0, "acc_lim_theta", "positive", self.acc_lim_theta)
        check(self.max_vel_theta > 0.0, "max_vel_theta", "positive", self.max_vel_theta)


@dataclass(frozen=True)
class RecoverySettings:
    """One behaviour of the list: its name and official type; metres."""

    name: str
    type: str
    reset_distance: float = 3.0
    affected_maps: str = "both"
    rotate: RotateSettings = field(default_factory=RotateSettings)

    def __post_init__(self):
        check(self.reset_distance >= 0.0, "reset_distance", "at least 0", self.reset_distance)
        maps = self.affected_maps
        check(maps in ("local", "global", "both"), "affected_maps", "local, global or both", maps)


@dataclass(frozen=True)
class RecoveryContext:
    """What a behaviour may look at and change."""

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    period: float
    global_costmap: LayeredCostmap
    local_costmap: LayeredCostmap


class Recovery:
    """One run of a behaviour."""

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """The velocity for this period; None when the behaviour has ended."""
        raise NotImplementedError


class ClearCostmap(Recovery):
    """Forgets obstacles outside a square round the robot; what the laser still sees comes back at once."""

    def __init__(self, settings: RecoverySettings):
        self._settings = settings

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        side, affected = self._settings.reset_distance, self._settings.affected_maps
        if affected in ("global", "both"):
            context.global_costmap.clear_outside(context.base_in_map, side)
        if affected in ("local", "both"):
            context.local_costmap.clear_outside(context.base_in_local, side)
        return None


class Rotate(Recovery):
    """One full turn to the left to look around; ends early if the footprint would touch something."""

    def __init__(self, settings: RotateSettings):
        self._settings = settings
        self._last_yaw: Optional[float] = None
        self._left = 2.0 * math.pi

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        settings, base = self._settings, context.base_in_local
        if self._last_yaw is not None:
            self._left -= wrap(base.yaw - self._last_yaw)
        self._last_yaw = base.yaw
        if self._left <= settings.yaw_goal_tolerance:
            return None
        if not context.local_costmap.has_room_to_turn(base, min(LOOKAHEAD_ANGLE, self._left)):
            return None
        stoppable = math.sqrt(2.0 * settings.acc_lim_theta * self._left)
        speed = min(max(stoppable, settings.min_in_place_vel_theta), settings.max_vel_theta)
        return Twist2(0.0, min(speed, context.twist.omega + settings.acc_lim_theta * context.period))


def recovery_from(settings: RecoverySettings) -> Recovery:
    """A new run of the behaviour. Raises SettingsError for a type that is not known."""
    kind = settings.type.rpartition("/")[2]
    if kind == "ClearCostmapRecovery":
        return ClearCostmap(settings)
    if kind == "RotateRecovery":
        return Rotate(settings.rotate)
    raise SettingsError(f"recovery_behaviors: {settings.name} has an unknown type {settings.type!r}")
