"""move_base's states: a plan is made, then driven, and what fails is cleared up before another plan is made.

Each function is one period in a state; the next one follows from what it leaves in the Pursuit.
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
from move_base_lite.navigator.goal_execution import GoalExecution, RobotState
from move_base_lite.planning import path_cost
from move_base_lite.recovery import RECOVERIES, RecoveryContext
from planar import Pose2, Twist2

# A plan under way is left only for one that is this much cheaper, lest the robot dither between two ways.
SWITCH_COST_RATIO = 0.8
# Metres beside its plan from which on the robot takes a new one in any case.
OFF_PLAN_DISTANCE = 0.3


class GoalReached(Exception):  # noqa: N818  -- nothing is wrong
    """The robot stands at its goal."""


class GoalAborted(Exception):  # noqa: N818
    """The goal cannot be reached: move_base's text of it, and why."""

    def __init__(self, text: str, reason: NavigationError):
        super().__init__(text)
        self.text, self.reason = text, reason


def step(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """What to do in this period. Raises HasArrived or GivenUp."""
    silent = components.costmaps.stale_source(state.now)
    if silent is not None:
        return _wait_for_sensor(execution, state, components, silent)
    if execution.status is Status.CLEARING:
        return _recover(execution, state, components)
    if execution.status is Status.PLANNING and not _plan(execution, state, components):
        return _wait_for_plan(execution, state, components)
    return _control(execution, state, components)


def _wait_for_sensor(
    execution: GoalExecution, state: RobotState, components: NavigatorComponents, topic: str
) -> Decision:
    silent_for = state.now - max(components.costmaps.last_stamp(topic), execution.last_progress_stamp)
    if silent_for > components.settings.move_base.sensor_patience:
        raise GoalAborted(STALE_SENSOR_TEXT, SensorStale(f"nothing on {topic} for {silent_for:.1f} s"))
    return Decision(execution.status, Twist2(), STALE_SENSOR_TEXT)


def _plan(
    execution: GoalExecution, state: RobotState, components: NavigatorComponents, is_under_way: bool = False
) -> bool:
    """Makes a plan and hands it to the controller; False if there is none, the reason is noted."""
    frequency = components.settings.move_base.planner_frequency
    execution.next_plan = state.now + (1.0 / frequency if frequency > 0.0 else math.inf)
    execution.planned_at = state.now
    try:
        path_xy = components.plan(state.base_in_map, execution.goal)
    except PlanningError as error:
        execution.on_planning_failed(error, state.now)
        return False
    if is_under_way and not _should_switch_plan(execution, path_xy, state.base_in_map, components):
        return True
    execution.path_xy = path_xy
    end_x, end_y = map(float, path_xy[-1])
    components.controller.set_plan(path_xy, Pose2(end_x, end_y, execution.goal.yaw))
    execution.on_plan_found()
    return True


def _should_switch_plan(
    execution: GoalExecution, path_xy: np.ndarray, base_in_map: Pose2, components: NavigatorComponents
) -> bool:
    left_xy = components.controller.plan_left_xy
    if (
        not len(execution.path_xy)
        or math.dist(left_xy[0], (base_in_map.x, base_in_map.y)) > OFF_PLAN_DISTANCE
    ):
        return True
    costmap = components.costmaps.global_costmap
    present, offered = (path_cost(costmap.costs, costmap.window, path) for path in (left_xy, path_xy))
    return offered < SWITCH_COST_RATIO * present


def _wait_for_plan(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """There is no plan yet."""
    settings = components.settings.move_base
    is_out_of_time = state.now - execution.planning_since > settings.planner_patience
    is_out_of_retries = 0 <= settings.max_planning_retries < execution.failed_plans
    if is_out_of_time or is_out_of_retries:
        execution.start_recovery(RecoveryTrigger.PLANNING)
    return Decision(execution.status, Twist2(), str(execution.reason), plan_xy=execution.path_xy)


def _control(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    settings, controller, now = components.settings.move_base, components.controller, state.now
    if controller.is_goal_reached(state.base_in_map, state.twist):
        raise GoalReached
    if now >= execution.next_plan - TIME_TOLERANCE:
        _plan(execution, state, components, is_under_way=True)
    plan_xy = execution.path_xy if execution.planned_at == now else None
    if execution.has_no_plan(now, settings.planner_patience):
        execution.start_recovery(RecoveryTrigger.PLANNING)
        return Decision(execution.status, Twist2(), str(execution.reason), plan_xy=plan_xy)
    if 0.0 < settings.oscillation_timeout < now - execution.last_progress_stamp:
        execution.start_recovery(RecoveryTrigger.OSCILLATION)
        execution.reason = _oscillation(execution, settings)
        return Decision(execution.status, Twist2(), plan_xy=plan_xy)
    highest = execution.speed_limit(state.base_in_odom, components.zones.max_speed(execution.pose))
    try:
        control = controller.control(components.control_context(state), highest)
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
    return Oscillation(
        text if execution.follows_commands else f"{text}, the robot does not move when it is told to"
    )


def _recover(execution: GoalExecution, state: RobotState, components: NavigatorComponents) -> Decision:
    """One period of a recovery behaviour, of the next one if none is under way."""
    start = None
    if execution.recovery is None:
        start = _begin_recovery(execution, components)
    assert execution.recovery is not None
    ahead = components.control_context(state)
    context = RecoveryContext(
        ahead.base_in_map,
        ahead.base_in_local,
        ahead.twist,
        components.period,
        components.costmaps.global_costmap,
        components.costmaps.local_costmap,
        lambda limit: setattr(execution, "speed_limit_until", (limit, state.base_in_odom)),
    )
    text = ""
    try:
        command = execution.recovery.step(context)
    except PluginFailed as failure:
        execution.reason, command, text = failure, None, str(failure)
    if command is None:
        execution.on_behavior_finished(state.now)
    return Decision(Status.CLEARING, command or Twist2(), text, recovery=start)


def _begin_recovery(execution: GoalExecution, components: NavigatorComponents) -> RecoveryStart:
    """The next behaviour of the list. Raises GivenUp if there is none."""
    recoveries = components.settings.recoveries
    is_enabled = components.settings.move_base.recovery_behavior_enabled
    if not is_enabled or execution.recovery_index >= len(recoveries):
        reason = execution.reason or NavigationError("no reason is known")
        raise GoalAborted(execution.trigger.value, reason)
    next_one = recoveries[execution.recovery_index]
    execution.recovery = RECOVERIES.make(next_one.settings)
    execution.recoveries_used += 1
    return RecoveryStart(next_one.name, execution.recovery_index, len(recoveries))
