"""State of the execution of one goal: what fails since when, and which recovery behaviour comes next."""

import math
from dataclasses import dataclass, field
from typing import Optional, Tuple

import numpy as np

from move_base_lite.errors import ControlError, NavigationError, PlanningError
from move_base_lite.navigator.decision import GoalOutcome, GoalProgress, RecoveryTrigger, Status
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.navigator.progress_checker import RecoveryProgressChecker
from move_base_lite.recovery import RecoveryBehavior, SpeedLimit
from planar import Pose2, Twist2, wrap

# Metres to travel before the average speed is used to estimate the remaining time.
MIN_TRAVEL_FOR_SPEED = 1.0
# After so much commanded motion, metres plus radians, odometry must show at least this fraction of it.
MIN_COMMANDED_MOTION, MIN_MOTION_FRACTION = 1.0, 0.1


@dataclass
class GoalExecution:
    """Execution state of one goal, read and written by the state machine.

    Attributes:
        goal: Goal in the map.
        started: When the goal was accepted [s].
        last_state: Robot at the latest tick.
        progress_state: Robot when it last made progress, by ~oscillation_distance.
        progress_stamp: When it last made progress, or a recovery behaviour ended [s].
        planning_since: Start of the time that ~planner_patience limits [s].
        next_plan: When the next plan is due [s].
        status: State of the state machine.
        trigger: What made the latest recovery necessary.
        control_fails_since: When control began to fail [s]; None while it succeeds.
        failed_plans: Failed plans since the last successful one.
        recovery_index: Next recovery behaviour in the list.
        recovery: Recovery behaviour that is running.
        error: Why planning or control failed last.
        travelled: Distance since the goal was accepted [m].
        recoveries_used: Recovery behaviours started for this goal.
        commanded_motion: Motion commanded since the last progress, metres plus radians.
        measured_motion: Motion measured by odometry since then, metres plus radians.
        speed_limit: Limit set by a recovery behaviour, and the robot's pose in odometry at that time.
        progress_checker: Checks plans found after recovery.
        path_xy: (N, 2) plan in the map; empty if the latest one failed.
        planned_at: When the latest plan was made [s].
    """

    goal: Pose2
    started: float
    last_state: RobotState
    progress_state: RobotState
    progress_stamp: float
    planning_since: float
    next_plan: float
    status: Status = Status.PLANNING
    trigger: RecoveryTrigger = RecoveryTrigger.PLANNING
    control_fails_since: Optional[float] = None
    failed_plans: int = 0
    recovery_index: int = 0
    recovery: Optional[RecoveryBehavior] = None
    error: Optional[NavigationError] = None
    travelled: float = 0.0
    recoveries_used: int = 0
    commanded_motion: float = 0.0
    measured_motion: float = 0.0
    speed_limit: Optional[Tuple[SpeedLimit, Pose2]] = None
    progress_checker: RecoveryProgressChecker = field(default_factory=RecoveryProgressChecker)
    path_xy: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    planned_at: float = -math.inf

    @classmethod
    def start(cls, goal: Pose2, state: RobotState) -> "GoalExecution":
        """Start the execution of a goal.

        Args:
            goal: Goal pose in the map frame.
            state: Robot state at this control tick.
        """
        now = state.stamp
        return cls(goal, now, state, state, now, now, now)

    @property
    def pose(self) -> Pose2:
        """Pose of the robot in the map at the latest tick."""
        return self.last_state.base_in_map

    def update(
        self, state: RobotState, oscillation_distance: float, commanded: Twist2, period: float
    ) -> None:
        """Update travelled distance and goal progress.

        Args:
            state: Robot state at this control tick.
            oscillation_distance: Displacement that counts as progress [m] (move_base: ~oscillation_distance).
            commanded: Velocity command in effect since the last tick.
            period: Control period [s].
        """
        self.commanded_motion += (abs(commanded.v) + abs(commanded.omega)) * period
        self.measured_motion += (abs(state.twist.v) + abs(state.twist.omega)) * period
        self.travelled += state.distance_to(self.last_state)
        self.last_state = state
        if state.distance_to(self.progress_state) >= oscillation_distance:
            self.progress_state = state
            self._restart_progress(state.stamp)
            self.on_resolved(RecoveryTrigger.OSCILLATION)

    def limit_speed(self, limit: SpeedLimit, base_in_odom: Pose2) -> None:
        """Apply the speed limit of a recovery behaviour.

        Args:
            limit: Speed limit.
            base_in_odom: Robot pose in the odometry frame, from which on the limit's distance counts.
        """
        self.speed_limit = (limit, base_in_odom)

    def max_speed(self, base_in_odom: Pose2, zone_speed: float) -> Twist2:
        """Compute the highest speeds allowed by zones and by a recovery behaviour.

        Args:
            base_in_odom: Robot pose in the odometry frame.
            zone_speed: Highest speed in the zones at the robot's position [m/s].
        """
        if self.speed_limit is not None:
            limit, start = self.speed_limit
            if base_in_odom.distance_to(start) < limit.distance:
                return Twist2(min(limit.highest.v, zone_speed), limit.highest.omega)
            self.speed_limit = None
        return Twist2(zone_speed, math.inf)

    def on_planning_failed(self, error: PlanningError, now: float) -> None:
        """Record that planning failed; a plan that is being followed stays in use.

        Args:
            error: Reason of the failure.
            now: Time [s].
        """
        if self.failed_plans == 0 and self.status is Status.CONTROLLING:
            self.planning_since = now
        self.failed_plans += 1
        self.error = self.progress_checker.planning_error = error
        self.path_xy = np.empty((0, 2))

    def needs_planning_recovery(self, now: float, patience: float) -> bool:
        """Check whether the plan in use makes no progress, or planning has failed for too long.

        Args:
            now: Time [s].
            patience: Time without a plan until recovery [s] (move_base: ~planner_patience).
        """
        if self.progress_checker.budget_exceeded(self.travelled):
            return True
        return self.failed_plans > 0 and now - max(self.planning_since, self.progress_stamp) > patience

    def on_planning_succeeded(self) -> None:
        """Record that there is a plan: control starts."""
        self.status = Status.CONTROLLING
        self.failed_plans = 0
        self.on_resolved(RecoveryTrigger.PLANNING)

    def on_control_succeeded(self, remaining: float) -> None:
        """Record that there is a velocity along the plan.

        Args:
            remaining: Length of the path that remains [m].
        """
        self.progress_checker.on_control_succeeded(self.travelled, remaining)
        self.control_fails_since = None
        self.on_resolved(RecoveryTrigger.CONTROLLING)

    def on_control_failed(self, error: ControlError, now: float, patience: float) -> None:
        """Record that there is no velocity along the plan: plan again, or start recovery.

        Args:
            error: Reason of the failure.
            now: Time [s].
            patience: Time without a velocity until recovery [s] (move_base: ~controller_patience).
        """
        self.error = error
        if self.control_fails_since is None:
            self.control_fails_since = now
        if now - self.control_fails_since > patience:
            self.start_recovery(RecoveryTrigger.CONTROLLING)
        else:
            self.replan(now)

    def on_resolved(self, trigger: RecoveryTrigger) -> None:
        """Restart the list of recovery behaviours if a trigger was the reason of the latest recovery.

        Args:
            trigger: Failure that is resolved.
        """
        if self.trigger is trigger:
            self.recovery_index = self.progress_checker.behaviors_tried

    def start_recovery(self, trigger: RecoveryTrigger) -> None:
        """Switch to recovery."""
        self.status, self.trigger = Status.CLEARING, trigger
        if trigger is RecoveryTrigger.PLANNING:
            self.progress_checker.on_planning_failed()
            self.error = self.progress_checker.planning_error

    def replan(self, now: float) -> None:
        """Switch to planning, with full patience."""
        self.status = Status.PLANNING
        self.planning_since, self.failed_plans = now, 0

    def on_behavior_finished(self, now: float) -> None:
        """Record that a recovery behaviour has ended, and plan again."""
        self.recovery = None
        self.recovery_index += 1
        if self.trigger is RecoveryTrigger.PLANNING:
            self.progress_checker.on_behavior_finished(self.recovery_index)
        self.control_fails_since = None
        self._restart_progress(now)
        self.replan(now)

    @property
    def follows_commands(self) -> bool:
        """Whether the robot has moved at least a little of what was commanded since the last progress."""
        return (
            self.commanded_motion < MIN_COMMANDED_MOTION
            or self.measured_motion > MIN_MOTION_FRACTION * self.commanded_motion
        )

    def _restart_progress(self, now: float) -> None:
        self.progress_stamp, self.commanded_motion, self.measured_motion = now, 0.0, 0.0

    def progress(self, now: float, remaining: float, nominal_speed: float) -> GoalProgress:
        """Compute progress so far, and an estimate of what remains.

        Args:
            now: Time [s].
            remaining: Length of the path that remains [m].
            nominal_speed: Speed assumed until the robot has travelled far enough to measure its own [m/s].
        """
        seconds = now - self.started
        speed = self.travelled / seconds if self.travelled > MIN_TRAVEL_FOR_SPEED else nominal_speed
        return GoalProgress(seconds, self.travelled, self.recoveries_used, remaining, remaining / speed)

    def outcome(self, now: float, code: int, reason: str, text: str) -> GoalOutcome:
        """Create the outcome of the goal, with the robot's distance to it.

        Args:
            now: Time [s].
            code: Outcome code of move_base_flex (mbf_msgs/MoveBaseResult).
            reason: The outcome as a word, such as NO_PATH.
            text: Text of the action's result.
        """
        return GoalOutcome(
            code,
            reason,
            text,
            self.pose.distance_to(self.goal),
            abs(wrap(self.goal.yaw - self.pose.yaw)),
            self.recoveries_used,
            now - self.started,
        )
