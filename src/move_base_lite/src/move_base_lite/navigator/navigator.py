"""The Navigator: from poses and scans to velocities that reach a goal."""

from dataclasses import replace
from typing import Optional, Sequence

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import LayeredCostmap, Observation, observation_from_scan
from move_base_lite.errors import PlanningError, PluginFailed
from move_base_lite.navigator.components import NavigatorComponents
from move_base_lite.navigator.decision import (
    CANCELLED_OUTCOME,
    SUCCEEDED_OUTCOME,
    SUCCESS_TEXT,
    Decision,
    GoalOutcome,
    RecoveryTrigger,
    Status,
    with_reason,
)
from move_base_lite.navigator.goal_execution import GoalExecution, RobotState
from move_base_lite.navigator.state_machine import GoalAborted, GoalReached, step
from move_base_lite.navigator.zones import Zones
from move_base_lite.planning import Potential
from planar import OccupancyGrid, Pose2, Scan, Twist2
from planar.geometry.pose import check_pose


class Navigator:
    """Drives a differential-drive robot to one goal at a time, without colliding.

    Call :meth:`tick` once a control period. Plans on a costmap of the map, follows the plan on a costmap of
    the robot's surroundings, and tries recovery behaviours in order when either fails, as move_base does
    (states.py).
    """

    def __init__(
        self, settings: NavigatorSettings, grid: Optional[OccupancyGrid] = None, zones: Zones = Zones()
    ):
        self._grid, self.zones = grid, zones
        self._components = NavigatorComponents(settings, grid, zones)
        self._new_goal: Optional[Pose2] = None
        self._execution: Optional[GoalExecution] = None

    def tick(
        self,
        now: float,
        base_in_map: Pose2,
        base_in_odom: Pose2,
        twist: Twist2,
        scan: Optional[Scan],
        observations: Sequence[Observation] = (),
        latency: float = 0.0,
    ) -> Decision:
        """The velocity for the coming period.

        ``now``: seconds; ``scan``: one not given before, as seen from the present pose, or None.
        ``sightings``: the same of any other sensors. ``latency``: seconds until the velocity takes effect.
        """
        self._components.latency = latency
        decision = self._decide(now, base_in_map, base_in_odom, twist, scan, observations)
        self._components.active_command = decision.command or Twist2()
        return decision

    def _decide(
        self,
        now: float,
        base_in_map: Pose2,
        base_in_odom: Pose2,
        twist: Twist2,
        scan: Optional[Scan],
        observations: Sequence[Observation],
    ) -> Decision:
        state = RobotState(now, base_in_map, base_in_odom, twist)
        if scan is not None:
            observations = [*observations, observation_from_scan(self.settings.scan_topic, scan)]
        try:
            if self.is_active or not self.settings.move_base.shutdown_costmaps:
                self._components.update_costmaps(state, observations)
            self._accept_goal(state)
            if self._execution is None:
                return Decision(Status.IDLE)
            distance = self.settings.move_base.oscillation_distance
            self._execution.advance(state, distance, self._components.active_command, self._components.period)
            decision = step(self._execution, state, self._components)
        except GoalReached:
            outcome = self._outcome(now, SUCCEEDED_OUTCOME, "SUCCESS", SUCCESS_TEXT)
            return self._end(Status.SUCCEEDED, SUCCESS_TEXT, outcome)
        except GoalAborted as end:
            text = with_reason(end.text, end.reason)
            outcome = self._outcome(now, end.reason.outcome, end.reason.code, text)
            return self._end(Status.ABORTED, text, outcome)
        except PluginFailed as failure:
            return self._abort_for_plugin(failure, now)
        left, usual_speed = self._components.controller.distance_left, self.settings.controller.max_vel_x
        return replace(decision, progress=self._execution.progress(now, left, usual_speed))

    def _accept_goal(self, state: RobotState) -> None:
        """Begins to pursue a new goal, if there is one. Raises GivenUp for one that can never be reached."""
        goal, self._new_goal = self._new_goal, None
        if goal is not None:
            self._execution = GoalExecution.of(goal, state)
            try:
                self._components.costmaps.check_goal(goal)
            except PlanningError as error:
                raise GoalAborted(RecoveryTrigger.PLANNING.value, error) from error

    def set_goal(self, goal_in_map: Pose2) -> None:
        """Drives there from the next tick on; a goal under way is left without stopping.

        Raises OutOfRangeError for a place at which no robot can be.
        """
        check_pose(goal_in_map, "a goal")
        self._new_goal = goal_in_map

    def cancel(self, now: float) -> Decision:
        """Ends the goal under way, if there is one: the robot is to stop at once."""
        if not self.is_active:
            return Decision(Status.IDLE)
        return self._end(Status.CANCELLED, "", self._outcome(now, CANCELLED_OUTCOME, "CANCELLED", ""))

    def clear_goal(self) -> None:
        """Drops the goal without a word; the robot has to be stopped by other means."""
        self._new_goal = self._execution = None
        self._components.reset_controller()

    def reset(self) -> None:
        """Forgets the goal and all that was seen, as after a jump of time."""
        self.set_map(self._grid)
        self.clear_goal()

    def set_map(self, grid: Optional[OccupancyGrid]) -> None:
        """Goes on with another map, from which obstacles have to be seen anew."""
        self._grid = grid
        self._components.set_map(grid)

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Goes on with other settings, goal and plan included."""
        self._components.update_settings(settings)

    @property
    def settings(self) -> NavigatorSettings:
        """Those in force."""
        return self._components.settings

    @property
    def is_active(self) -> bool:
        """Whether there is a goal."""
        return self._execution is not None or self._new_goal is not None

    @property
    def global_costmap(self) -> LayeredCostmap:
        """The costmap to plan on, in the map's frame."""
        return self._components.costmaps.global_costmap

    @property
    def local_costmap(self) -> LayeredCostmap:
        """The costmap to drive on, in odometry's frame."""
        return self._components.costmaps.local_costmap

    @property
    def potential(self) -> Optional[Potential]:
        """The wave of the newest plan, if the settings ask for it."""
        return self._components.planner.potential

    def make_plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Path (N, 2) in the map between any two places. Raises PlanningError, and as ``set_goal``."""
        check_pose(start_in_map, "a start")
        check_pose(goal_in_map, "a goal")
        return self._components.plan(start_in_map, goal_in_map, tolerance)

    def clear_costmaps(self) -> None:
        """Forgets all obstacles that are not in the map."""
        self._components.costmaps.clear()

    def clear_around(self, base_in_map: Pose2) -> None:
        """Forgets what obstacles the map's costmap shows where the robot stands."""
        radius = self.settings.move_base.clearing_radius
        self.global_costmap.clear_around(
            base_in_map, 2.0 * (radius or self.global_costmap.footprint.circumscribed_radius)
        )

    def _abort_for_plugin(self, failure: PluginFailed, now: float) -> Decision:
        """Costs that a layer has failed to tell cannot be relied on: no goal is pursued then."""
        if not self.is_active:
            return Decision(Status.IDLE, text=str(failure))
        text = with_reason(RecoveryTrigger.CONTROLLING.value, failure)
        return self._end(Status.ABORTED, text, self._outcome(now, failure.outcome, failure.code, text))

    def _outcome(self, now: float, code: int, reason: str, text: str) -> GoalOutcome:
        if self._execution is None:
            return GoalOutcome(code, reason, text)
        return self._execution.outcome(now, code, reason, text)

    def _end(self, status: Status, text: str, outcome: GoalOutcome) -> Decision:
        self.clear_goal()
        return Decision(status, Twist2(), text, outcome=outcome)
