"""The Navigator: move_base's state machine, from poses and scans to velocities."""

import math
from dataclasses import dataclass, replace
from typing import Dict, Optional, Sequence, Tuple

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import Controller
from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, LayeredCostmap, Sighting, sighting_of_scan
from move_base_lite.decision import (
    CANCELLED_OUTCOME,
    STALE_SENSOR_TEXT,
    SUCCEEDED_OUTCOME,
    SUCCESS_TEXT,
    Decision,
    Outcome,
    Progress,
    RecoveryStart,
    Status,
    Trigger,
    with_reason,
)
from move_base_lite.errors import (
    ControlError,
    GoalBlocked,
    NavigationError,
    Oscillation,
    OutOfMap,
    PlanningError,
    SensorStale,
)
from move_base_lite.planning import GlobalPlanner, path_cost
from move_base_lite.recovery import Recovery, RecoveryContext, SpeedLimit, recovery_from
from planar import OccupancyGrid, Pose2, Scan, Twist2, wrap

TIME_TOLERANCE = 1e-6
UNLIMITED = Twist2(math.inf, math.inf)
# A plan under way is left only for one that is this much cheaper, lest the robot dither between two ways.
WORTH_CHANGING = 0.8
# Metres beside its plan from which on the robot takes a new one in any case.
ASTRAY = 0.3
# Metres after which the speed so far tells how long the rest will take.
TELLING_DISTANCE = 1.0


@dataclass
class _Pursuit:
    """The pursuit of one goal: since when what has failed, and how far recovery has come."""

    goal: Pose2
    started: float
    pose: Pose2
    progress_pose: Pose2
    last_progress: float
    planning_since: float
    next_plan: float
    status: Status = Status.PLANNING
    trigger: Trigger = Trigger.PLANNING
    control_fails_since: Optional[float] = None
    failed_plans: int = 0
    recovery_index: int = 0
    recovery: Optional[Recovery] = None
    reason: Optional[NavigationError] = None
    travelled: float = 0.0
    recoveries_used: int = 0
    slow: Optional[Tuple[SpeedLimit, Pose2]] = None

    def advance(self, base_in_map: Pose2) -> None:
        self.travelled += self.pose.distance_to(base_in_map)
        self.pose = base_in_map


class Navigator:
    """Drives a differential-drive robot to one goal at a time, without colliding.

    Call :meth:`tick` once a control period. Plans on a costmap of the map, follows the plan on a costmap of
    the robot's surroundings, and tries recovery behaviours in order when either fails, as move_base does.
    """

    def __init__(self, settings: NavigatorSettings, grid: Optional[OccupancyGrid] = None):
        self._settings = settings
        self._period = 1.0 / settings.move_base.controller_frequency
        self._planner = GlobalPlanner(settings.planner)
        self._grid = grid
        self._scan_topic = settings.scan_topic
        self.forget()

    def forget(self) -> None:
        """Forgets the goal and all that was seen, as after a jump of time."""
        self._last_seen: Dict[str, float] = {}
        self.set_map(self._grid)
        self.forget_goal()

    def set_map(self, grid: Optional[OccupancyGrid]) -> None:
        """Goes on with another map, from which obstacles have to be seen anew."""
        self._grid = grid
        self.global_costmap = LayeredCostmap(self._settings.global_costmap, grid)
        self.local_costmap = LayeredCostmap(self._settings.local_costmap, grid)
        self._next_updates = [-math.inf, -math.inf]

    def set_goal(self, goal_in_map: Pose2) -> None:
        """Drives there from the next tick on; a goal under way is left without stopping."""
        self._new_goal: Optional[Pose2] = goal_in_map
        self._is_cancelled = False

    def cancel(self) -> None:
        """Stops at the next tick."""
        self._is_cancelled = self.is_active

    def forget_goal(self) -> None:
        """Drops the goal without a word; the robot has to be stopped by other means."""
        self._new_goal = None
        self._pursuit: Optional[_Pursuit] = None
        self._is_cancelled = False
        self._controller = Controller(self._settings.controller, self._period)

    @property
    def is_active(self) -> bool:
        """Whether there is a goal."""
        return self._pursuit is not None or self._new_goal is not None

    def tick(
        self,
        now: float,
        base_in_map: Pose2,
        base_in_odom: Pose2,
        twist: Twist2,
        scan: Optional[Scan],
        sightings: Sequence[Sighting] = (),
    ) -> Decision:
        """The velocity for the coming period.

        ``now``: seconds; ``scan``: one not given before, as seen from the present pose, or None.
        ``sightings``: the same of any other sensors.
        """
        if scan is not None:
            sightings = [*sightings, sighting_of_scan(self._scan_topic, scan)]
        self._look(now, base_in_map, base_in_odom, sightings)
        if self._new_goal is not None and not self._is_cancelled:
            self._pursuit = _Pursuit(self._new_goal, now, base_in_map, base_in_map, now, now, now)
            self._new_goal = None
            try:
                self._check(self._pursuit.goal)
            except PlanningError as error:
                return self._give_up(now, Trigger.PLANNING.value, error)
        if self._is_cancelled:
            return self._end(Status.CANCELLED, "", self._outcome(now, CANCELLED_OUTCOME, "CANCELLED", ""))
        if self._pursuit is None:
            return Decision(Status.IDLE)
        pursuit = self._pursuit
        pursuit.advance(base_in_map)
        decision = self._pursue(pursuit, now, base_in_map, base_in_odom, twist)
        return decision if decision.status.is_final else replace(decision, progress=self._progress(now))

    def _pursue(
        self, pursuit: _Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        self._note_progress(pursuit, now, base_in_map)
        silent = self._silent_source(now)
        if silent is not None:
            return self._wait_for_sensor(pursuit, now, silent)
        if pursuit.status is Status.CLEARING:
            return self._recover(pursuit, now, base_in_map, base_in_odom, twist)
        if pursuit.status is Status.PLANNING and not self._plan(pursuit, now, base_in_map):
            return self._be_patient_with_planning(pursuit, now)
        return self._drive(pursuit, now, base_in_map, base_in_odom, twist)

    def make_plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Path (N, 2) in the map between any two places. Raises PlanningError."""
        return self._planner.plan(
            self.global_costmap.costs,
            self.global_costmap.window,
            (start_in_map.x, start_in_map.y),
            (goal_in_map.x, goal_in_map.y),
            tolerance,
        )

    def clear_costmaps(self) -> None:
        """Forgets all obstacles that are not in the map."""
        self.local_costmap.reset()
        self.global_costmap.reset()

    def clear_around(self, base_in_map: Pose2) -> None:
        """Forgets what obstacles the map's costmap shows where the robot stands."""
        radius = self._settings.move_base.clearing_radius
        self.global_costmap.clear_around(
            base_in_map, 2.0 * (radius or self.global_costmap.footprint.circumscribed_radius)
        )

    def _look(
        self, now: float, base_in_map: Pose2, base_in_odom: Pose2, sightings: Sequence[Sighting]
    ) -> None:
        """Has the costmaps note what is seen, and brings those up to date that are due."""
        if self._settings.move_base.shutdown_costmaps and not self.is_active:
            return
        map_in_odom = base_in_odom @ base_in_map.inverse()
        views = (
            (self.local_costmap, base_in_odom, map_in_odom),
            (self.global_costmap, base_in_map, Pose2()),
        )
        for sighting in sightings:
            self._last_seen[sighting.topic] = sighting.stamp
        for number, (costmap, base_in_frame, map_in_frame) in enumerate(views):
            for sighting in sightings:
                costmap.note(sighting, base_in_frame)
            if now >= self._next_updates[number] - TIME_TOLERANCE:
                costmap.update(base_in_frame, map_in_frame)
                frequency = costmap.settings.update_frequency
                self._next_updates[number] = now + (1.0 / frequency if frequency > 0.0 else math.inf)

    def _check(self, goal: Pose2) -> None:
        """Says at once what no recovery can change: a goal off the map, or in the map's own obstacles."""
        costmap, where = self.global_costmap, f"the goal at ({goal.x:.2f}, {goal.y:.2f})"
        if not costmap.window.contains(goal.x, goal.y):
            raise OutOfMap(f"{where} is outside the map")
        if self._settings.planner.default_tolerance > 0.0:
            return
        cost = costmap.costs_of_map[costmap.window.cell_of(goal.x, goal.y)]
        if cost == LETHAL:
            raise GoalBlocked(f"{where} is in an obstacle of the map")
        if cost == INSCRIBED:
            raise GoalBlocked(f"{where} is too close to an obstacle of the map")
        if cost == UNKNOWN and not self._settings.planner.allow_unknown:
            raise GoalBlocked(f"{where} is in unknown space")

    def _note_progress(self, pursuit: _Pursuit, now: float, base_in_map: Pose2) -> None:
        if base_in_map.distance_to(pursuit.progress_pose) >= self._settings.move_base.oscillation_distance:
            pursuit.progress_pose, pursuit.last_progress = base_in_map, now
            if pursuit.trigger is Trigger.OSCILLATION:
                pursuit.recovery_index = 0

    def _silent_source(self, now: float) -> Optional[str]:
        """The topic of a sensor whose newest data are older than a costmap allows, if there is one."""
        for costmap in (self._settings.local_costmap, self._settings.global_costmap):
            for source in costmap.obstacles.sources if costmap.obstacles.enabled else ():
                age = now - self._last_seen.get(source.topic, -math.inf)
                if 0.0 < source.expected_update_rate < age:
                    return source.topic
        return None

    def _wait_for_sensor(self, pursuit: _Pursuit, now: float, topic: str) -> Decision:
        since = max(self._last_seen.get(topic, -math.inf), pursuit.last_progress)
        if now - since > self._settings.move_base.sensor_patience:
            return self._give_up(
                now, STALE_SENSOR_TEXT, SensorStale(f"nothing on {topic} for {now - since:.1f} s")
            )
        return Decision(pursuit.status, Twist2(), STALE_SENSOR_TEXT)

    def _plan(self, pursuit: _Pursuit, now: float, base_in_map: Pose2, is_under_way: bool = False) -> bool:
        """Makes a plan and hands it to the controller; False if there is none, the reason is noted."""
        frequency = self._settings.move_base.planner_frequency
        pursuit.next_plan = now + (1.0 / frequency if frequency > 0.0 else math.inf)
        self._planned_at = now
        try:
            plan_xy = self.make_plan(base_in_map, pursuit.goal)
        except PlanningError as error:
            pursuit.reason = error
            self._plan_xy = np.empty((0, 2))
            return False
        if is_under_way and not self._is_worth_changing(plan_xy, base_in_map):
            return True
        self._plan_xy = plan_xy
        end_x, end_y = map(float, self._plan_xy[-1])
        self._controller.set_plan(self._plan_xy, Pose2(end_x, end_y, pursuit.goal.yaw))
        pursuit.status = Status.CONTROLLING
        pursuit.failed_plans = 0
        if pursuit.trigger is Trigger.PLANNING:
            pursuit.recovery_index = 0
        return True

    def _is_worth_changing(self, plan_xy: np.ndarray, base_in_map: Pose2) -> bool:
        left_xy = self._controller.plan_left_xy
        if not len(self._plan_xy) or math.dist(left_xy[0], (base_in_map.x, base_in_map.y)) > ASTRAY:
            return True
        costmap = self.global_costmap
        present, offered = (path_cost(costmap.costs, costmap.window, path) for path in (left_xy, plan_xy))
        return offered < WORTH_CHANGING * present

    def _be_patient_with_planning(self, pursuit: _Pursuit, now: float) -> Decision:
        settings = self._settings.move_base
        pursuit.failed_plans += 1
        is_out_of_time = now - pursuit.planning_since > settings.planner_patience
        is_out_of_retries = 0 <= settings.max_planning_retries < pursuit.failed_plans
        if is_out_of_time or is_out_of_retries:
            pursuit.status, pursuit.trigger = Status.CLEARING, Trigger.PLANNING
        return Decision(pursuit.status, Twist2(), str(pursuit.reason), plan_xy=self._plan_xy)

    def _drive(
        self, pursuit: _Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        settings = self._settings.move_base
        if self._controller.is_goal_reached(base_in_map, twist):
            outcome = self._outcome(now, SUCCEEDED_OUTCOME, "SUCCESS", SUCCESS_TEXT)
            return self._end(Status.SUCCEEDED, SUCCESS_TEXT, outcome)
        if now >= pursuit.next_plan - TIME_TOLERANCE:
            self._plan(pursuit, now, base_in_map, is_under_way=True)
        plan_xy = self._plan_xy if self._planned_at == now else None
        if 0.0 < settings.oscillation_timeout < now - pursuit.last_progress:
            pursuit.status, pursuit.trigger = Status.CLEARING, Trigger.OSCILLATION
            pursuit.reason = Oscillation(
                f"less than {settings.oscillation_distance:g} m driven in {settings.oscillation_timeout:g} s"
            )
            return Decision(pursuit.status, Twist2(), plan_xy=plan_xy)
        try:
            control = self._controller.control(
                base_in_map, base_in_odom, twist, self.local_costmap, self._speed_limit(pursuit, base_in_odom)
            )
        except ControlError as error:
            self._be_patient_with_control(pursuit, now, error)
            return Decision(pursuit.status, Twist2(), str(error), plan_xy=plan_xy)
        pursuit.control_fails_since = None
        if pursuit.trigger is Trigger.CONTROLLING:
            pursuit.recovery_index = 0
        return Decision(
            pursuit.status,
            control.command,
            plan_xy=plan_xy,
            trajectory=control.poses,
            followed_xy=control.plan_xy,
        )

    @staticmethod
    def _speed_limit(pursuit: _Pursuit, base_in_odom: Pose2) -> Twist2:
        """The highest speeds that anything but the controller's own settings allows."""
        if pursuit.slow is not None:
            limit, since = pursuit.slow
            if base_in_odom.distance_to(since) < limit.distance:
                return limit.highest
            pursuit.slow = None
        return UNLIMITED

    def _be_patient_with_control(self, pursuit: _Pursuit, now: float, error: ControlError) -> None:
        """Without a velocity another plan may help, or, after a while, recovery."""
        pursuit.reason = error
        if pursuit.control_fails_since is None:
            pursuit.control_fails_since = now
        if now - pursuit.control_fails_since > self._settings.move_base.controller_patience:
            pursuit.status, pursuit.trigger = Status.CLEARING, Trigger.CONTROLLING
        else:
            pursuit.status = Status.PLANNING
            pursuit.planning_since, pursuit.failed_plans = now, 0

    def _recover(
        self, pursuit: _Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        recoveries = self._settings.recoveries
        start = None
        if pursuit.recovery is None:
            is_enabled = self._settings.move_base.recovery_behavior_enabled
            if not is_enabled or pursuit.recovery_index >= len(recoveries):
                reason = pursuit.reason or NavigationError("no reason is known")
                return self._give_up(now, pursuit.trigger.value, reason)
            next_one = recoveries[pursuit.recovery_index]
            pursuit.recovery = recovery_from(next_one)
            pursuit.recoveries_used += 1
            start = RecoveryStart(next_one.name, pursuit.recovery_index, len(recoveries))
        context = RecoveryContext(
            base_in_map,
            base_in_odom,
            twist,
            self._period,
            self.global_costmap,
            self.local_costmap,
            lambda limit: setattr(pursuit, "slow", (limit, base_in_odom)),
        )
        command = pursuit.recovery.step(context)
        if command is None:
            pursuit.recovery = None
            pursuit.recovery_index += 1
            pursuit.status = Status.PLANNING
            pursuit.last_progress = pursuit.planning_since = now
            pursuit.control_fails_since = None
            pursuit.failed_plans = 0
        return Decision(Status.CLEARING, command or Twist2(), recovery=start)

    def _progress(self, now: float) -> Optional[Progress]:
        pursuit = self._pursuit
        if pursuit is None:
            return None
        left = self._controller.distance_left
        highest = self._settings.controller.max_vel_x
        seconds = now - pursuit.started
        speed = pursuit.travelled / seconds if pursuit.travelled > TELLING_DISTANCE else highest
        return Progress(seconds, pursuit.travelled, pursuit.recoveries_used, left, left / speed)

    def _outcome(self, now: float, code: int, reason: str, text: str) -> Outcome:
        pursuit = self._pursuit
        if pursuit is None:
            return Outcome(code, reason, text)
        return Outcome(
            code,
            reason,
            text,
            pursuit.pose.distance_to(pursuit.goal),
            abs(wrap(pursuit.goal.yaw - pursuit.pose.yaw)),
            pursuit.recoveries_used,
            now - pursuit.started,
        )

    def _give_up(self, now: float, text: str, error: NavigationError) -> Decision:
        text = with_reason(text, error)
        return self._end(Status.ABORTED, text, self._outcome(now, error.outcome, error.code, text))

    def _end(self, status: Status, text: str, outcome: Outcome) -> Decision:
        self.forget_goal()
        return Decision(status, Twist2(), text, outcome=outcome)
