"""move_base in an episode, and its client; messages between them take one control period, as in lock-step."""

from typing import Optional

import numpy as np

from headless_mission.encoding import Encoding, ExactValues
from move_base_lite import (
    Decision,
    MoveBase,
    NavigationError,
    NavigatorSettings,
    PoseHistory,
    Status,
)
from move_base_lite.move_base import TickResult
from move_base_lite.navigator.zones import Zones
from planar import OccupancyGrid, Pose2
from planar.driving import DriveOutcome
from sim_bridge import Episode, EpisodeHooks, StepResult
from sim_bridge.sensors.odometry import Odometer

# Names in actionlib_msgs/GoalStatus.
GOAL_STATUS = {Status.SUCCEEDED: "SUCCEEDED", Status.ABORTED: "ABORTED", Status.CANCELLED: "PREEMPTED"}


class NavigationHooks(EpisodeHooks):
    """Passes what the robot measures to MoveBase, ticks it and commands the robot.

    Args:
        settings: Parameters of move_base.
        grid: Static map; None for none.
        encoding: Precision of what the robot measures.
        zones: Keep-out and speed zones.

    Attributes:
        poses: Poses of the robot, as in tf.
        move_base: What the node move_base does.
        result: Result of the latest tick.
        diagnosis: First fault of a sensor that was found; empty if there was none.
        period: Control period [s].
    """

    def __init__(
        self,
        settings: NavigatorSettings,
        grid: Optional[OccupancyGrid] = None,
        encoding: Encoding = ExactValues(),
        zones: Zones = Zones(),
    ):
        self.poses, self._encoding = PoseHistory(), encoding
        self.move_base = MoveBase(settings, self.poses, grid, zones)
        self.result = TickResult(Decision(Status.IDLE))
        self.diagnosis = ""
        self.period = 1.0 / settings.move_base.controller_frequency

    @property
    def base_in_map(self) -> Optional[Pose2]:
        """Estimated pose of the robot; None while it is unknown."""
        odom_in_map, base_in_odom = self.poses.odom_in_map(), self.poses.base_in_odom()
        return None if odom_in_map is None or base_in_odom is None else odom_in_map @ base_in_odom

    def after_step(self, episode: Episode, step: StepResult) -> None:
        if Odometer.name in step.readings:
            odometry = step.odometry
            base_in_odom = self._encoding.pose(odometry.base_in_odom)
            self.poses.add_odometry(step.stamp, base_in_odom)
            self.move_base.add_odometry(step.stamp, base_in_odom, odometry.twist)
        scan = step.scan
        if scan is not None:
            self.move_base.add_scan(self._encoding.scan(scan))

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        if not self.move_base.is_due(step.stamp):
            self.result = TickResult(Decision(Status.IDLE))
            return
        self.result = result = self.move_base.tick(step.stamp, episode.latency)
        episode.command = result.decision.command
        self.diagnosis = self.diagnosis or result.fault or ""


class EpisodeMoveBaseClient(EpisodeHooks):
    """Client of move_base in the same process (pick_objects: MoveBasePort); its hooks precede move_base's.

    Args:
        navigation: move_base in the episode.
        encoding: Precision of goals and feedback.

    Attributes:
        robot: Robot pose in the map from the latest feedback; None before the first.
    """

    def __init__(self, navigation: NavigationHooks, encoding: Encoding = ExactValues()):
        self._navigation, self._encoding = navigation, encoding
        self.robot: Optional[Pose2] = None
        self._goal: Optional[Pose2] = None
        self._is_cancelled = False
        self._outcome: Optional[DriveOutcome] = None

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Receive what move_base sent at the last tick, and deliver what was sent to it."""
        result = self._navigation.result
        if result.state is not None and result.decision.status is not Status.IDLE:
            self.robot = self._encoding.pose(result.state.base_in_map)
        status = GOAL_STATUS.get(result.decision.status)
        if status is not None and self._goal is None:  # else a new goal has replaced the one that ended
            self._outcome = DriveOutcome(status, result.decision.text)
        goal, self._goal = self._goal, None
        if self._is_cancelled and self._navigation.move_base.is_active:
            episode.command = self._navigation.move_base.cancel(step.stamp).command
        self._is_cancelled = False
        if goal is not None:
            self._navigation.move_base.set_goal(goal)

    def send(self, goal: Pose2) -> None:
        """Send a goal, which replaces any earlier one."""
        self._goal, self._outcome = self._encoding.pose(goal), None

    def cancel(self) -> None:
        """Cancel the goal, if there is one."""
        self._goal, self._outcome, self._is_cancelled = None, None, True

    def outcome(self) -> Optional[DriveOutcome]:
        """Return the outcome of the last goal once; None while it is active and afterwards."""
        outcome, self._outcome = self._outcome, None
        return outcome

    def plan_length(self, start: Optional[Pose2], end: Pose2) -> Optional[float]:
        """Return the length of a plan from ``start``, or from the robot, to ``end`` [m]; None without one."""
        start = self._navigation.base_in_map if start is None else start
        try:
            corners = self._navigation.move_base.navigator.make_plan(start or Pose2(), end)
        except NavigationError:
            return None
        return float(np.hypot(*np.diff(corners, axis=0).T).sum())
