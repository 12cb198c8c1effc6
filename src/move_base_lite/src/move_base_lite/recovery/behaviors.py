"""Recovery behaviours, one step a control period, so that each can be cancelled at any time."""

import math
from dataclasses import dataclass, field
from typing import Callable, Optional

from move_base_lite.costmap import LayeredCostmap
from planar import Pose2, SettingsError, Twist2, wrap
from planar.config.settings import check

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
class SlowSettings:
    """What is cleared around the robot, and how fast it may go until it has moved on: m, m/s, rad/s."""

    clearing_distance: float = 0.5
    limited_trans_speed: float = 0.25
    limited_rot_speed: float = 0.45
    limited_distance: float = 0.3

    def __post_init__(self):
        for name in ("limited_trans_speed", "limited_rot_speed"):
            check(getattr(self, name) > 0.0, name, "positive", getattr(self, name))
        for name in ("clearing_distance", "limited_distance"):
            check(getattr(self, name) >= 0.0, name, "at least 0", getattr(self, name))


@dataclass(frozen=True)
class RecoverySettings:
    """One behaviour of the list: its name and official type; metres.

    ``reset_distance``, ``invert_area_to_clear``, ``affected_maps``: for one that clears costmaps; ``rotate``
    and ``slow`` for the others.
    """

    name: str
    type: str
    reset_distance: float = 3.0
    invert_area_to_clear: bool = False
    affected_maps: str = "both"
    rotate: RotateSettings = field(default_factory=RotateSettings)
    slow: SlowSettings = field(default_factory=SlowSettings)

    def __post_init__(self):
        check(self.reset_distance >= 0.0, "reset_distance", "at least 0", self.reset_distance)
        maps = self.affected_maps
        check(maps in ("local", "global", "both"), "affected_maps", "local, global or both", maps)


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


class Recovery:
    """One run of a behaviour."""

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """The velocity for this period; None when the behaviour has ended."""
        raise NotImplementedError


class ClearCostmap(Recovery):
    """Forgets obstacles outside a square round the robot, or inside it; what is still seen comes back."""

    def __init__(self, settings: RecoverySettings):
        self._settings = settings

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        side, affected = self._settings.reset_distance, self._settings.affected_maps
        for name, costmap, base in (
            ("global", context.global_costmap, context.base_in_map),
            ("local", context.local_costmap, context.base_in_local),
        ):
            if affected in (name, "both"):
                clear = costmap.clear_around if self._settings.invert_area_to_clear else costmap.clear_outside
                clear(base, side)
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


class MoveSlow(Recovery):
    """Forgets obstacles near the robot and has it go on slowly."""

    def __init__(self, settings: SlowSettings):
        self._settings = settings

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        settings = self._settings
        context.global_costmap.clear_around(context.base_in_map, 2.0 * settings.clearing_distance)
        context.local_costmap.clear_around(context.base_in_local, 2.0 * settings.clearing_distance)
        highest = Twist2(settings.limited_trans_speed, settings.limited_rot_speed)
        context.limit_speed(SpeedLimit(highest, settings.limited_distance))
        return None


def recovery_from(settings: RecoverySettings) -> Recovery:
    """A new run of the behaviour. Raises SettingsError for a type that is not known."""
    kind = settings.type.rpartition("/")[2]
    if kind == "ClearCostmapRecovery":
        return ClearCostmap(settings)
    if kind == "RotateRecovery":
        return Rotate(settings.rotate)
    if kind == "MoveSlowAndClear":
        return MoveSlow(settings.slow)
    raise SettingsError(f"recovery_behaviors: {settings.name} has an unknown type {settings.type!r}")
