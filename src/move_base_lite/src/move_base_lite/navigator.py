"""The Navigator: move_base's state machine, from poses and scans to velocities."""

import math
from dataclasses import replace
from typing import Optional, Sequence

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import Controller, Situation
from move_base_lite.costmap import LayeredCostmap, Sighting, sighting_of_scan
from move_base_lite.costmaps import TIME_TOLERANCE, Costmaps
from move_base_lite.decision import (
    CANCELLED_OUTCOME,
    STALE_SENSOR_TEXT,
    SUCCEEDED_OUTCOME,
    SUCCESS_TEXT,
    Decision,
    Outcome,
    RecoveryStart,
    Status,
    Trigger,
    with_reason,
)
from move_base_lite.errors import ControlError, NavigationError, Oscillation, PlanningError, SensorStale
from move_base_lite.movers import Movers
from move_base_lite.planning import GlobalPlanner, Potential, path_cost
from move_base_lite.pursuit import Pursuit
from move_base_lite.recovery import RecoveryContext, recovery_from
from move_base_lite.zones import Zones
from planar import OccupancyGrid, Pose2, Scan, Twist2

# A plan under way is left only for one that is this much cheaper, lest the robot dither between two ways.
WORTH_CHANGING = 0.8
# Metres beside its plan from which on the robot takes a new one in any case.
ASTRAY = 0.3


class Navigator:
    """Drives a differential-drive robot to one goal at a time, without colliding.

    Call :meth:`tick` once a control period. Plans on a costmap of the map, follows the plan on a costmap of
    the robot's surroundings, and tries recovery behaviours in order when either fails, as move_base does.
    """

    def __init__(
        self, settings: NavigatorSettings, grid: Optional[OccupancyGrid] = None, zones: Zones = Zones()
    ):
        self.settings = settings
        self._planner = GlobalPlanner(settings.planner)
        self._grid = grid
        self.zones = zones
        self.forget()

    def forget(self) -> None:
        """Forgets the goal and all that was seen, as after a jump of time."""
        self.set_map(self._grid)
        self.forget_goal()

    def set_map(self, grid: Optional[OccupancyGrid]) -> None:
        """Goes on with another map, from which obstacles have to be seen anew."""
        self._grid = grid
        self._costmaps = Costmaps(self.settings, grid, self.zones)
        self._movers = Movers()

    def change(self, settings: NavigatorSettings) -> None:
        """Goes on with other settings, goal and plan included."""
        self.settings = settings
        self._planner = GlobalPlanner(settings.planner)
        self._controller.change(settings.controller, self._period)
        self._costmaps.change(settings)

    @property
    def global_costmap(self) -> LayeredCostmap:
        """The costmap to plan on, in the map's frame."""
        return self._costmaps.whole

    @property
    def local_costmap(self) -> LayeredCostmap:
        """The costmap to drive on, in odometry's frame."""
        return self._costmaps.near

    @property
    def potential(self) -> Optional[Potential]:
        """The wave of the newest plan, if the settings ask for it."""
        return self._planner.potential

    @property
    def _period(self) -> float:
        return 1.0 / self.settings.move_base.controller_frequency

    def set_goal(self, goal_in_map: Pose2) -> None:
        """Drives there from the next tick on; a goal under way is left without stopping."""
        self._new_goal: Optional[Pose2] = goal_in_map

    def cancel(self, now: float) -> Decision:
        """Ends the goal under way: the robot is to stop at once."""
        return self._end(Status.CANCELLED, "", self._outcome(now, CANCELLED_OUTCOME, "CANCELLED", ""))

    def forget_goal(self) -> None:
        """Drops the goal without a word; the robot has to be stopped by other means."""
        self._new_goal = None
        self._pursuit: Optional[Pursuit] = None
        self._controller = Controller(self.settings.controller, self._period)

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
            sightings = [*sightings, sighting_of_scan(self.settings.scan_topic, scan)]
        if self.is_active or not self.settings.move_base.shutdown_costmaps:
            lasting = [self._lasting(base_in_odom, sighting) for sighting in sightings]
            self._costmaps.look(now, base_in_map, base_in_odom, sightings, lasting)
        if self._new_goal is not None:
            self._pursuit = Pursuit.of(self._new_goal, now, base_in_map)
            self._new_goal = None
            try:
                self._costmaps.check_goal(self._pursuit.goal)
            except PlanningError as error:
                return self._give_up(now, Trigger.PLANNING.value, error)
        if self._pursuit is None:
            return Decision(Status.IDLE)
        pursuit = self._pursuit
        pursuit.advance(now, base_in_map, self.settings.move_base.oscillation_distance)
        decision = self._pursue(pursuit, now, base_in_map, base_in_odom, twist)
        if decision.status.is_final:
            return decision
        usual_speed = self.settings.controller.max_vel_x
        progress = pursuit.progress(now, self._controller.distance_left, usual_speed)
        return replace(decision, progress=progress)

    def _pursue(
        self, pursuit: Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        silent = self._costmaps.silent_source(now)
        if silent is not None:
            return self._wait_for_sensor(pursuit, now, silent)
        if pursuit.status is Status.CLEARING:
            return self._recover(pursuit, now, base_in_map, base_in_odom, twist)
        if pursuit.status is Status.PLANNING and not self._plan(pursuit, now, base_in_map):
            return self._be_patient_with_planning(pursuit, now)
        return self._drive(pursuit, now, base_in_map, base_in_odom, twist)

    def _lasting(self, base_in_odom: Pose2, sighting: Sighting) -> Sighting:
        """What is seen without what moves: a plan does not have to lead around people who walk."""
        if not self.settings.controller.looks_for_movers or sighting.topic != self.settings.scan_topic:
            return sighting
        return self._movers.look(base_in_odom, sighting)

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
        self._costmaps.clear()

    def clear_around(self, base_in_map: Pose2) -> None:
        """Forgets what obstacles the map's costmap shows where the robot stands."""
        radius = self.settings.move_base.clearing_radius
        self.global_costmap.clear_around(
            base_in_map, 2.0 * (radius or self.global_costmap.footprint.circumscribed_radius)
        )

    def _wait_for_sensor(self, pursuit: Pursuit, now: float, topic: str) -> Decision:
        since = max(self._costmaps.last_seen(topic), pursuit.last_progress)
        if now - since > self.settings.move_base.sensor_patience:
            return self._give_up(
                now, STALE_SENSOR_TEXT, SensorStale(f"nothing on {topic} for {now - since:.1f} s")
            )
        return Decision(pursuit.status, Twist2(), STALE_SENSOR_TEXT)

    def _plan(self, pursuit: Pursuit, now: float, base_in_map: Pose2, is_under_way: bool = False) -> bool:
        """Makes a plan and hands it to the controller; False if there is none, the reason is noted."""
        frequency = self.settings.move_base.planner_frequency
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
        pursuit.has_overcome(Trigger.PLANNING)
        return True

    def _is_worth_changing(self, plan_xy: np.ndarray, base_in_map: Pose2) -> bool:
        left_xy = self._controller.plan_left_xy
        if not len(self._plan_xy) or math.dist(left_xy[0], (base_in_map.x, base_in_map.y)) > ASTRAY:
            return True
        costmap = self.global_costmap
        present, offered = (path_cost(costmap.costs, costmap.window, path) for path in (left_xy, plan_xy))
        return offered < WORTH_CHANGING * present

    def _be_patient_with_planning(self, pursuit: Pursuit, now: float) -> Decision:
        settings = self.settings.move_base
        pursuit.failed_plans += 1
        is_out_of_time = now - pursuit.planning_since > settings.planner_patience
        is_out_of_retries = 0 <= settings.max_planning_retries < pursuit.failed_plans
        if is_out_of_time or is_out_of_retries:
            pursuit.clear_up(Trigger.PLANNING)
        return Decision(pursuit.status, Twist2(), str(pursuit.reason), plan_xy=self._plan_xy)

    def _drive(
        self, pursuit: Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        settings = self.settings.move_base
        if self._controller.is_goal_reached(base_in_map, twist):
            outcome = self._outcome(now, SUCCEEDED_OUTCOME, "SUCCESS", SUCCESS_TEXT)
            return self._end(Status.SUCCEEDED, SUCCESS_TEXT, outcome)
        if now >= pursuit.next_plan - TIME_TOLERANCE:
            self._plan(pursuit, now, base_in_map, is_under_way=True)
        plan_xy = self._plan_xy if self._planned_at == now else None
        if 0.0 < settings.oscillation_timeout < now - pursuit.last_progress:
            pursuit.clear_up(Trigger.OSCILLATION)
            pursuit.reason = Oscillation(
                f"less than {settings.oscillation_distance:g} m driven in {settings.oscillation_timeout:g} s"
            )
            return Decision(pursuit.status, Twist2(), plan_xy=plan_xy)
        try:
            control = self._controller.control(
                Situation(
                    base_in_map,
                    base_in_odom,
                    twist,
                    self.local_costmap,
                    self._speed_limit(pursuit, base_in_odom),
                    self._movers.at(now),
                )
            )
        except ControlError as error:
            self._be_patient_with_control(pursuit, now, error)
            return Decision(
                pursuit.status,
                Twist2(),
                str(error),
                plan_xy=plan_xy,
                exploration=self._controller.exploration,
            )
        pursuit.control_fails_since = None
        pursuit.has_overcome(Trigger.CONTROLLING)
        return Decision(
            pursuit.status,
            control.command,
            plan_xy=plan_xy,
            trajectory=control.poses,
            followed_xy=control.plan_xy,
            exploration=self._controller.exploration,
        )

    def _speed_limit(self, pursuit: Pursuit, base_in_odom: Pose2) -> Twist2:
        """The highest speeds that anything but the controller's own settings allows."""
        allowed = self.zones.max_speed(pursuit.pose)
        if pursuit.slow is not None:
            limit, since = pursuit.slow
            if base_in_odom.distance_to(since) < limit.distance:
                return Twist2(min(limit.highest.v, allowed), limit.highest.omega)
            pursuit.slow = None
        return Twist2(allowed, math.inf)

    def _be_patient_with_control(self, pursuit: Pursuit, now: float, error: ControlError) -> None:
        """Without a velocity another plan may help, or, after a while, recovery."""
        pursuit.reason = error
        if pursuit.control_fails_since is None:
            pursuit.control_fails_since = now
        if now - pursuit.control_fails_since > self.settings.move_base.controller_patience:
            pursuit.clear_up(Trigger.CONTROLLING)
        else:
            pursuit.plan_anew(now)

    def _recover(
        self, pursuit: Pursuit, now: float, base_in_map: Pose2, base_in_odom: Pose2, twist: Twist2
    ) -> Decision:
        recoveries = self.settings.recoveries
        start = None
        if pursuit.recovery is None:
            is_enabled = self.settings.move_base.recovery_behavior_enabled
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
            pursuit.end_recovery(now)
        return Decision(Status.CLEARING, command or Twist2(), recovery=start)

    def _outcome(self, now: float, code: int, reason: str, text: str) -> Outcome:
        if self._pursuit is None:
            return Outcome(code, reason, text)
        return self._pursuit.outcome(now, code, reason, text)

    def _give_up(self, now: float, text: str, error: NavigationError) -> Decision:
        text = with_reason(text, error)
        return self._end(Status.ABORTED, text, self._outcome(now, error.outcome, error.code, text))

    def _end(self, status: Status, text: str, outcome: Outcome) -> Decision:
        self.forget_goal()
        return Decision(status, Twist2(), text, outcome=outcome)
