"""The pursuit of one goal: since when what has failed, and how far recovery has come."""

import math
from dataclasses import dataclass, field
from typing import Optional, Tuple

import numpy as np

from move_base_lite.errors import ControlError, NavigationError, PlanningError
from move_base_lite.navigator.decision import GoalOutcome, GoalProgress, RecoveryTrigger, Status
from move_base_lite.navigator.progress_checker import RecoveryProgressChecker
from move_base_lite.recovery import RecoveryBehavior, SpeedLimit
from planar import Pose2, Twist2, wrap

# Metres after which the speed so far tells how long the rest will take.
MIN_TRAVEL_FOR_SPEED = 1.0
# Metres and radians that it is told to move, and the share of them that it moves at least, or it cannot.
MIN_COMMANDED_MOTION, MIN_MOTION_FRACTION = 1.0, 0.1


@dataclass(frozen=True)
class RobotState:
    """The robot in this control period: seconds, its pose in two frames, its velocity."""

    now: float
    base_in_map: Pose2
    base_in_odom: Pose2
    twist: Twist2

    def distance_to(self, other: "RobotState") -> float:
        """What localization and odometry agree on: no jump of an estimate, no wheels that spin."""
        return min(
            self.base_in_map.distance_to(other.base_in_map), self.base_in_odom.distance_to(other.base_in_odom)
        )


@dataclass
class GoalExecution:
    """What the Navigator remembers while it has a goal: when and where the robot was last, and last got on.

    ``path_xy``: (N, 2) in the map, the plan in use, made at ``planned_at``; empty if the last one failed.
    ``told``, ``moved``: since the last progress, metres and radians together that it was told to move, and
    that odometry says it has.
    """

    goal: Pose2
    started: float
    last: RobotState
    last_progress: RobotState
    last_progress_stamp: float
    planning_since: float
    next_plan: float
    status: Status = Status.PLANNING
    trigger: RecoveryTrigger = RecoveryTrigger.PLANNING
    control_fails_since: Optional[float] = None
    failed_plans: int = 0
    recovery_index: int = 0
    recovery: Optional[RecoveryBehavior] = None
    reason: Optional[NavigationError] = None
    travelled: float = 0.0
    recoveries_used: int = 0
    commanded: float = 0.0
    moved: float = 0.0
    speed_limit_until: Optional[Tuple[SpeedLimit, Pose2]] = None
    progress_checker: RecoveryProgressChecker = field(default_factory=RecoveryProgressChecker)
    path_xy: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    planned_at: float = -math.inf

    @classmethod
    def of(cls, goal: Pose2, state: RobotState) -> "GoalExecution":
        """A pursuit that begins now and here."""
        now = state.now
        return cls(goal, now, state, state, now, now, now)

    @property
    def pose(self) -> Pose2:
        """Where the robot was last, in the map."""
        return self.last.base_in_map

    def advance(
        self, state: RobotState, oscillation_distance: float, commanded: Twist2, period: float
    ) -> None:
        """The robot has moved on; so many metres from where it was before are progress.

        ``told``: the velocity that was in force, for ``period`` seconds.
        """
        self.commanded += (abs(commanded.v) + abs(commanded.omega)) * period
        self.moved += (abs(state.twist.v) + abs(state.twist.omega)) * period
        self.travelled += state.distance_to(self.last)
        self.last = state
        if state.distance_to(self.last_progress) >= oscillation_distance:
            self.last_progress = state
            self._count_from(state.now)
            self.on_resolved(RecoveryTrigger.OSCILLATION)

    def speed_limit(self, base_in_odom: Pose2, allowed: float) -> Twist2:
        """The highest speeds that anything but the controller's own settings allows.

        ``allowed``: m/s, where the robot is; a recovery may have it go more slowly for a while.
        """
        if self.speed_limit_until is not None:
            limit, since = self.speed_limit_until
            if base_in_odom.distance_to(since) < limit.distance:
                return Twist2(min(limit.highest.v, allowed), limit.highest.omega)
            self.speed_limit_until = None
        return Twist2(allowed, math.inf)

    def on_planning_failed(self, error: PlanningError, now: float) -> None:
        """There is no plan; the last one is driven on if it is under way."""
        if self.failed_plans == 0 and self.status is Status.CONTROLLING:
            self.planning_since = now
        self.failed_plans += 1
        self.reason = self.progress_checker.reason = error
        self.path_xy = np.empty((0, 2))

    def has_no_plan(self, now: float, patience: float) -> bool:
        """Whether the plan under way leads nowhere, and none has been found that does for so many seconds."""
        if self.progress_checker.budget_exceeded(self.travelled):
            return True
        return self.failed_plans > 0 and now - max(self.planning_since, self.last_progress_stamp) > patience

    def on_plan_found(self) -> None:
        """There is a plan."""
        self.status = Status.CONTROLLING
        self.failed_plans = 0
        self.on_resolved(RecoveryTrigger.PLANNING)

    def on_control_succeeded(self, distance_left: float) -> None:
        """There is a velocity along a plan of which so many metres are left."""
        self.progress_checker.on_control_succeeded(self.travelled, distance_left)
        self.control_fails_since = None
        self.on_resolved(RecoveryTrigger.CONTROLLING)

    def on_control_failed(self, error: ControlError, now: float, patience: float) -> None:
        """Without a velocity another plan may help, or, after so many seconds, recovery."""
        self.reason = error
        if self.control_fails_since is None:
            self.control_fails_since = now
        if now - self.control_fails_since > patience:
            self.start_recovery(RecoveryTrigger.CONTROLLING)
        else:
            self.replan(now)

    def on_resolved(self, trigger: RecoveryTrigger) -> None:
        """What recovery was begun for is no more: the next trouble starts with the first behaviour."""
        if self.trigger is trigger:
            self.recovery_index = self.progress_checker.behaviors_tried

    def start_recovery(self, trigger: RecoveryTrigger) -> None:
        """Recovery is to begin."""
        self.status, self.trigger = Status.CLEARING, trigger
        if trigger is RecoveryTrigger.PLANNING:
            self.progress_checker.on_planning_failed()
            self.reason = self.progress_checker.reason

    def replan(self, now: float) -> None:
        """Another plan is to be made, with full patience."""
        self.status = Status.PLANNING
        self.planning_since, self.failed_plans = now, 0

    def on_behavior_finished(self, now: float) -> None:
        """One behaviour has ended; the next trouble gets the next one."""
        self.recovery = None
        self.recovery_index += 1
        if self.trigger is RecoveryTrigger.PLANNING:
            self.progress_checker.on_behavior_finished(self.recovery_index)
        self.control_fails_since = None
        self._count_from(now)
        self.replan(now)

    @property
    def follows_commands(self) -> bool:
        """Whether the robot does, to some extent, what it has been told since the last progress."""
        return self.commanded < MIN_COMMANDED_MOTION or self.moved > MIN_MOTION_FRACTION * self.commanded

    def _count_from(self, now: float) -> None:
        self.last_progress_stamp, self.commanded, self.moved = now, 0.0, 0.0

    def progress(self, now: float, distance_left: float, usual_speed: float) -> GoalProgress:
        """How it stands; before the robot's own speed tells, the usual one says how long the rest takes."""
        seconds = now - self.started
        speed = self.travelled / seconds if self.travelled > MIN_TRAVEL_FOR_SPEED else usual_speed
        return GoalProgress(
            seconds, self.travelled, self.recoveries_used, distance_left, distance_left / speed
        )

    def outcome(self, now: float, code: int, reason: str, text: str) -> GoalOutcome:
        """How it ended."""
        return GoalOutcome(
            code,
            reason,
            text,
            self.pose.distance_to(self.goal),
            abs(wrap(self.goal.yaw - self.pose.yaw)),
            self.recoveries_used,
            now - self.started,
        )
