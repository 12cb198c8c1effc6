"""move_base's state machine: make a plan, follow it, check goal progress, and recover when one of them fails.

Each function runs one control period in a state; the GoalExecution holds the next state.
"""

import math

import numpy as np

from move_base_lite.config import MoveBaseSettings
from move_base_lite.errors import (
    ControlError,
    NavigationError,
    Oscillation,
    PlanningError,
    PluginFailed,
    SensorStale,
)
from move_base_lite.navigator.components import NavigatorComponents
from move_base_lite.navigator.costmaps import TIME_TOLERANCE
from move_base_lite.navigator.decision import (
    STALE_SENSOR_TEXT,
    Decision,
    RecoveryStart,
    RecoveryTrigger,
    Status,
)
from move_base_lite.navigator.goal_execution import GoalExecution
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.planning import path_cost
from move_base_lite.recovery import RECOVERIES, RecoveryContext
from planar import Pose2, Twist2

# Cost of a new plan relative to the present one below which the robot switches: hysteresis against dithering.
SWITCH_COST_RATIO = 0.8
# Metres beside its plan from which on the robot switches in any case.
OFF_PLAN_DISTANCE = 0.3


class GoalSucceeded(Exception):  # noqa: N818  -- not an error
    """The robot stands at its goal."""


class GoalAborted(Exception):  # noqa: N818
    """The goal cannot be reached.

    Attributes:
        text: move_base's text for it.
        reason: Why the goal was aborted.
    """

    def __init__(self, text: str, reason: NavigationError):
        """Create the exception.

        Args:
            text: move_base's text.
            reason: Why the goal was aborted.
        """
        super().__init__(text)
        self.text, self.reason = text, reason


def step(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """Run one control period.

    Args:
        execution: State of the goal; modified.
        state: Robot state at this control tick.
        components: Planners and costmaps.

    Returns:
        Decision for this period.

    Raises:
        GoalSucceeded: The robot stands at the goal.
        GoalAborted: A sensor sends no data, or all recovery behaviours have been tried.
    """
    topic = components.costmaps.stale_source(state.stamp)
    if topic is not None:
        return _wait_for_sensor(execution, state, components, topic)
    if execution.status is Status.CLEARING:
        return _recover(execution, state, components)
    if execution.status is Status.PLANNING and not _plan(execution, state, components):
        return _wait_for_plan(execution, state, components)
    return _control(execution, state, components)


def _wait_for_sensor(
    execution: GoalExecution, state: RobotState, components: NavigatorComponents, topic: str
) -> Decision:
    age = state.stamp - max(components.costmaps.last_stamp(topic), execution.progress_stamp)
    if age > components.settings.move_base.sensor_patience:
        raise GoalAborted(STALE_SENSOR_TEXT, SensorStale(f"nothing on {topic} for {age:.1f} s"))
    return Decision(execution.status, Twist2(), STALE_SENSOR_TEXT)


def _plan(
    execution: GoalExecution, state: RobotState, components: NavigatorComponents, has_plan: bool = False
) -> bool:
    """Make a plan and pass it to the controller; return whether there is one."""
    frequency = components.settings.move_base.planner_frequency
    execution.next_plan = state.stamp + (1.0 / frequency if frequency > 0.0 else math.inf)
    execution.planned_at = state.stamp
    try:
        path_xy = components.plan(state.base_in_map, execution.goal)
    except PlanningError as error:
        execution.on_planning_failed(error, state.stamp)
        return False
    if has_plan and not _should_switch_plan(execution, path_xy, state.base_in_map, components):
        return True
    execution.path_xy = path_xy
    end_x, end_y = map(float, path_xy[-1])
    components.controller.set_plan(path_xy, Pose2(end_x, end_y, execution.goal.yaw))
    execution.on_planning_succeeded()
    return True


def _should_switch_plan(
    execution: GoalExecution, path_xy: np.ndarray, base_in_map: Pose2, components: NavigatorComponents
) -> bool:
    left_xy = components.controller.plan_left_xy
    if not len(execution.path_xy):
        return True
    if math.dist(left_xy[0], (base_in_map.x, base_in_map.y)) > OFF_PLAN_DISTANCE:
        return True
    costmap = components.costmaps.global_costmap
    present, new = (path_cost(costmap.costs, costmap.window, path) for path in (left_xy, path_xy))
    return new < SWITCH_COST_RATIO * present


def _wait_for_plan(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """Stand still without a plan; start recovery when the patience ends."""
    settings = components.settings.move_base
    is_out_of_time = state.stamp - execution.planning_since > settings.planner_patience
    is_out_of_retries = 0 <= settings.max_planning_retries < execution.failed_plans
    if is_out_of_time or is_out_of_retries:
        execution.start_recovery(RecoveryTrigger.PLANNING)
    return Decision(execution.status, Twist2(), str(execution.error), plan_xy=execution.path_xy)


def _control(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """Follow the plan and check goal progress; start recovery if there is none (oscillation)."""
    settings, controller, now = components.settings.move_base, components.controller, state.stamp
    if controller.is_goal_reached(state.base_in_map, state.twist):
        raise GoalSucceeded
    if now >= execution.next_plan - TIME_TOLERANCE:
        _plan(execution, state, components, has_plan=True)
    plan_xy = None
    if execution.planned_at == now:  # a plan that was kept begins at the robot, too
        plan_xy = controller.plan_left_xy if len(execution.path_xy) else execution.path_xy
    if execution.needs_planning_recovery(now, settings.planner_patience):
        execution.start_recovery(RecoveryTrigger.PLANNING)
        return Decision(execution.status, Twist2(), str(execution.error), plan_xy=plan_xy)
    if 0.0 < settings.oscillation_timeout < now - execution.progress_stamp:
        execution.start_recovery(RecoveryTrigger.OSCILLATION)
        execution.error = _oscillation(execution, settings)
        return Decision(execution.status, Twist2(), plan_xy=plan_xy)
    max_speed = execution.max_speed(state.base_in_odom, components.zones.max_speed(execution.pose))
    try:
        control = controller.control(components.control_context(state), max_speed)
    except ControlError as error:
        execution.on_control_failed(error, now, settings.controller_patience)
        return Decision(
            execution.status,
            Twist2(),
            str(error),
            plan_xy=plan_xy,
            trajectory_samples=error.trajectory_samples,
        )
    execution.on_control_succeeded(controller.distance_left)
    return Decision(
        execution.status,
        control.command,
        plan_xy=plan_xy,
        trajectory=control.poses,
        followed_xy=control.path_xy,
        trajectory_samples=control.trajectory_samples,
    )


def _oscillation(execution: GoalExecution, settings: MoveBaseSettings) -> Oscillation:
    distance, seconds = settings.oscillation_distance, settings.oscillation_timeout
    text = f"less than {distance:g} m driven in {seconds:g} s"
    if not execution.follows_commands:
        text += ", the robot does not move when commanded"
    return Oscillation(text)


def _recover(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """Run one period of the recovery behaviour; start the next behaviour if none is running."""
    start = None
    if execution.recovery is None:
        start = _start_behavior(execution, components)
    assert execution.recovery is not None
    ahead = components.control_context(state)
    context = RecoveryContext(
        ahead.base_in_map,
        ahead.base_in_local,
        ahead.twist,
        components.period,
        components.costmaps.global_costmap,
        components.costmaps.local_costmap,
        lambda limit: execution.limit_speed(limit, state.base_in_odom),
    )
    text = ""
    try:
        command = execution.recovery.step(context)
    except PluginFailed as failure:
        execution.error, command, text = failure, None, str(failure)
    if command is None:
        execution.on_behavior_finished(state.stamp)
    return Decision(Status.CLEARING, command or Twist2(), text, recovery=start)


def _start_behavior(execution: GoalExecution, components: NavigatorComponents) -> RecoveryStart:
    """Start the next recovery behaviour of the list.

    Raises:
        GoalAborted: If there is none left.
    """
    recoveries = components.settings.recoveries
    is_enabled = components.settings.move_base.recovery_behavior_enabled
    if not is_enabled or execution.recovery_index >= len(recoveries):
        raise GoalAborted(execution.trigger.value, execution.error or NavigationError("no reason is known"))
    behavior = recoveries[execution.recovery_index]
    execution.recovery = RECOVERIES.make(behavior.settings)
    execution.recoveries_used += 1
    return RecoveryStart(behavior.name, execution.recovery_index, len(recoveries))
