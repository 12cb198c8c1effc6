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
from move_base_lite.navigator.costmaps import TIME_TOLERANCE
from move_base_lite.navigator.crew import Crew
from move_base_lite.navigator.decision import STALE_SENSOR_TEXT, Decision, RecoveryStart, Status, Trigger
from move_base_lite.navigator.pursuit import Moment, Pursuit
from move_base_lite.planning import path_cost
from move_base_lite.recovery import RECOVERIES, RecoveryContext
from planar import Pose2, Twist2

# A plan under way is left only for one that is this much cheaper, lest the robot dither between two ways.
WORTH_CHANGING = 0.8
# Metres beside its plan from which on the robot takes a new one in any case.
ASTRAY = 0.3


class HasArrived(Exception):  # noqa: N818  -- nothing is wrong
    """The robot stands at its goal."""


class GivenUp(Exception):  # noqa: N818
    """The goal cannot be reached: move_base's text of it, and why."""

    def __init__(self, text: str, reason: NavigationError):
        super().__init__(text)
        self.text, self.reason = text, reason


def step(pursuit: Pursuit, moment: Moment, crew: Crew) -> Decision:
    """What to do in this period. Raises HasArrived or GivenUp."""
    silent = crew.costmaps.silent_source(moment.now)
    if silent is not None:
        return _wait_for_sensor(pursuit, moment, crew, silent)
    if pursuit.status is Status.CLEARING:
        return _clear_up(pursuit, moment, crew)
    if pursuit.status is Status.PLANNING and not _plan(pursuit, moment, crew):
        return _be_patient(pursuit, moment, crew)
    return _drive(pursuit, moment, crew)


def _wait_for_sensor(pursuit: Pursuit, moment: Moment, crew: Crew, topic: str) -> Decision:
    silent_for = moment.now - max(crew.costmaps.last_seen(topic), pursuit.last_progress)
    if silent_for > crew.settings.move_base.sensor_patience:
        raise GivenUp(STALE_SENSOR_TEXT, SensorStale(f"nothing on {topic} for {silent_for:.1f} s"))
    return Decision(pursuit.status, Twist2(), STALE_SENSOR_TEXT)


def _plan(pursuit: Pursuit, moment: Moment, crew: Crew, is_under_way: bool = False) -> bool:
    """Makes a plan and hands it to the controller; False if there is none, the reason is noted."""
    frequency = crew.settings.move_base.planner_frequency
    pursuit.next_plan = moment.now + (1.0 / frequency if frequency > 0.0 else math.inf)
    pursuit.planned_at = moment.now
    try:
        path_xy = crew.plan(moment.base_in_map, pursuit.goal)
    except PlanningError as error:
        pursuit.plan_has_failed(error, moment.now)
        return False
    if is_under_way and not _is_worth_changing(pursuit, path_xy, moment.base_in_map, crew):
        return True
    pursuit.path_xy = path_xy
    end_x, end_y = map(float, path_xy[-1])
    crew.controller.set_plan(path_xy, Pose2(end_x, end_y, pursuit.goal.yaw))
    pursuit.drive()
    return True


def _is_worth_changing(pursuit: Pursuit, path_xy: np.ndarray, base_in_map: Pose2, crew: Crew) -> bool:
    left_xy = crew.controller.plan_left_xy
    if not len(pursuit.path_xy) or math.dist(left_xy[0], (base_in_map.x, base_in_map.y)) > ASTRAY:
        return True
    costmap = crew.costmaps.whole
    present, offered = (path_cost(costmap.costs, costmap.window, path) for path in (left_xy, path_xy))
    return offered < WORTH_CHANGING * present


def _be_patient(pursuit: Pursuit, moment: Moment, crew: Crew) -> Decision:
    """There is no plan yet."""
    settings = crew.settings.move_base
    is_out_of_time = moment.now - pursuit.planning_since > settings.planner_patience
    is_out_of_retries = 0 <= settings.max_planning_retries < pursuit.failed_plans
    if is_out_of_time or is_out_of_retries:
        pursuit.clear_up(Trigger.PLANNING)
    return Decision(pursuit.status, Twist2(), str(pursuit.reason), plan_xy=pursuit.path_xy)


def _drive(pursuit: Pursuit, moment: Moment, crew: Crew) -> Decision:
    settings, controller, now = crew.settings.move_base, crew.controller, moment.now
    if controller.is_goal_reached(moment.base_in_map, moment.twist):
        raise HasArrived
    if now >= pursuit.next_plan - TIME_TOLERANCE:
        _plan(pursuit, moment, crew, is_under_way=True)
    plan_xy = pursuit.path_xy if pursuit.planned_at == now else None
    if pursuit.is_at_a_loss(now, settings.planner_patience):
        pursuit.clear_up(Trigger.PLANNING)
        return Decision(pursuit.status, Twist2(), str(pursuit.reason), plan_xy=plan_xy)
    if 0.0 < settings.oscillation_timeout < now - pursuit.last_progress:
        pursuit.clear_up(Trigger.OSCILLATION)
        pursuit.reason = _oscillation(pursuit, settings)
        return Decision(pursuit.status, Twist2(), plan_xy=plan_xy)
    highest = pursuit.speed_limit(moment.base_in_odom, crew.zones.max_speed(pursuit.pose))
    try:
        control = controller.control(crew.situation(moment), highest)
    except ControlError as error:
        pursuit.control_has_failed(error, now, settings.controller_patience)
        return Decision(pursuit.status, Twist2(), str(error), plan_xy=plan_xy, exploration=error.exploration)
    pursuit.control_has_succeeded(controller.distance_left)
    return Decision(
        pursuit.status,
        control.command,
        plan_xy=plan_xy,
        trajectory=control.poses,
        followed_xy=control.path_xy,
        exploration=control.exploration,
    )


def _oscillation(pursuit: Pursuit, settings: MoveBaseSettings) -> Oscillation:
    distance, seconds = settings.oscillation_distance, settings.oscillation_timeout
    text = f"less than {distance:g} m driven in {seconds:g} s"
    return Oscillation(text if pursuit.obeys else f"{text}, the robot does not move when it is told to")


def _clear_up(pursuit: Pursuit, moment: Moment, crew: Crew) -> Decision:
    """One period of a recovery behaviour, of the next one if none is under way."""
    start = None
    if pursuit.recovery is None:
        start = _begin_recovery(pursuit, crew)
    assert pursuit.recovery is not None
    ahead = crew.situation(moment)
    context = RecoveryContext(
        ahead.base_in_map,
        ahead.base_in_local,
        ahead.twist,
        crew.period,
        crew.costmaps.whole,
        crew.costmaps.near,
        lambda limit: setattr(pursuit, "slow", (limit, moment.base_in_odom)),
    )
    text = ""
    try:
        command = pursuit.recovery.step(context)
    except PluginFailed as failure:
        pursuit.reason, command, text = failure, None, str(failure)
    if command is None:
        pursuit.end_recovery(moment.now)
    return Decision(Status.CLEARING, command or Twist2(), text, recovery=start)


def _begin_recovery(pursuit: Pursuit, crew: Crew) -> RecoveryStart:
    """The next behaviour of the list. Raises GivenUp if there is none."""
    recoveries = crew.settings.recoveries
    is_enabled = crew.settings.move_base.recovery_behavior_enabled
    if not is_enabled or pursuit.recovery_index >= len(recoveries):
        reason = pursuit.reason or NavigationError("no reason is known")
        raise GivenUp(pursuit.trigger.value, reason)
    next_one = recoveries[pursuit.recovery_index]
    pursuit.recovery = RECOVERIES.make(next_one.settings)
    pursuit.recoveries_used += 1
    return RecoveryStart(next_one.name, pursuit.recovery_index, len(recoveries))
