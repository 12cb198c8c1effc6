"""What the commander's commands do: drives by move_base, and short motions by odometry."""

import enum
import math
import threading
import time
from dataclasses import dataclass
from typing import Callable, List, Optional, Sequence, Tuple

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from map_msgs.msg import OccupancyGridUpdate
from move_base_msgs.msg import MoveBaseGoal
from nav_msgs.msg import Odometry

from planar import OccupancyGrid, Pose2, wrap
from planar_ros.actions import goal_is_over, server_is_ready
from planar_ros.messages import OccupancyGridArrays, grid_from_msg, pose2_from_msg, pose2_to_msg

POLL_SECONDS = 0.02
# Wall-clock seconds after which what stands still is taken to be gone.
PATIENCE_SECONDS = 10.0
SLOW_DOWN = 1.5
"""A motion's speed is at most so many times what is left of it, per second."""
INSCRIBED = 99
"""Cells of a published costmap from here on are too close to an obstacle for the robot's centre."""


class Result(enum.Enum):
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class Outcome:
    """How a command ended, and why. ``missed``: the numbers of waypoints that were not reached."""

    result: Result
    reason: str
    missed: Tuple[int, ...] = ()

    @property
    def success(self) -> bool:
        return self.result is Result.SUCCEEDED


@dataclass(frozen=True)
class Feedback:
    """How far a command has come. ``left``: metres (straight) or radians; None if not known yet.

    ``waypoint``: the number, from 0, of the one that the robot is on its way to.
    """

    seconds: float
    left: Optional[float]
    pose: Optional[Pose2] = None
    waypoint: int = 0


class Task:
    """A command in progress. ``timeout``: seconds of ROS time."""

    def __init__(self, timeout: float):
        self._timeout = timeout
        self._start: Optional[float] = None
        self._is_cancelled = threading.Event()

    def run(self) -> Outcome:
        """Does it; returns how it ended."""
        raise NotImplementedError

    def feedback(self) -> Feedback:
        raise NotImplementedError

    def cancel(self) -> None:
        self._is_cancelled.set()

    @property
    def _seconds(self) -> float:
        return 0.0 if self._start is None else rospy.get_time() - self._start

    def _wait(self, step: Callable[[], Optional[Outcome]]) -> Outcome:
        """Calls ``step`` until it has an outcome, or another reason ends the command."""
        self._start = latest = rospy.get_time()
        ticked = time.monotonic()
        while True:
            outcome = step()
            if outcome is not None:
                return outcome
            now, wall = rospy.get_time(), time.monotonic()
            if now != latest:
                latest, ticked = now, wall
            if self._is_cancelled.is_set() or rospy.is_shutdown():
                return Outcome(Result.CANCELLED, "cancelled")
            if now - self._start > self._timeout:
                return Outcome(Result.TIMED_OUT, f"not done within {self._timeout:g} s")
            if wall - ticked > PATIENCE_SECONDS:
                return Outcome(Result.FAILED, f"the clock has stood still for {PATIENCE_SECONDS:g} s")
            time.sleep(POLL_SECONDS)


class Drive(Task):
    """A goal for move_base."""

    def __init__(self, client: actionlib.SimpleActionClient, frame_id: str, goal: Pose2, timeout: float):
        super().__init__(timeout)
        self.goal = goal
        self._client, self._frame_id = client, frame_id
        self._pose: Optional[Pose2] = None
        self._lost_since: Optional[float] = None

    def run(self) -> Outcome:
        if not all(map(math.isfinite, (self.goal.x, self.goal.y, self.goal.yaw))):
            return Outcome(Result.FAILED, f"the goal ({self.goal.x}, {self.goal.y}) is not a pose")
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = self._frame_id
        message.target_pose.header.stamp = rospy.Time.now()
        message.target_pose.pose = pose2_to_msg(self.goal)
        self._client.send_goal(message, feedback_cb=self._keep_pose)
        outcome = self._wait(self._look)
        if not goal_is_over(self._client):
            self._client.cancel_goal()
        return outcome

    def feedback(self) -> Feedback:
        left = None if self._pose is None else self._pose.distance_to(self.goal)
        return Feedback(self._seconds, left, self._pose)

    def _look(self) -> Optional[Outcome]:
        if not goal_is_over(self._client):
            return self._notice_loss()
        state = self._client.get_state()
        text = self._client.get_goal_status_text()
        if state == GoalStatus.SUCCEEDED:
            return Outcome(Result.SUCCEEDED, text or "goal reached")
        if state in (GoalStatus.PREEMPTED, GoalStatus.RECALLED):
            return Outcome(Result.CANCELLED, text or "another goal took its place")
        return Outcome(Result.FAILED, text or GoalStatus.to_string(state).lower())

    def _notice_loss(self) -> Optional[Outcome]:
        if server_is_ready(self._client):
            self._lost_since = None
        elif self._lost_since is None:
            self._lost_since = time.monotonic()
        elif time.monotonic() - self._lost_since > PATIENCE_SECONDS:
            return Outcome(Result.FAILED, f"the action {rospy.resolve_name('move_base')} is gone")
        return None

    def _keep_pose(self, feedback) -> None:
        self._pose = pose2_from_msg(feedback.base_position.pose)


class Waypoints(Task):
    """Drives one after the other."""

    def __init__(self, drives: Sequence[Drive], stop_on_failure: bool):
        super().__init__(math.inf)
        self._drives, self._stop_on_failure = drives, stop_on_failure
        self._number = 0
        self._start = rospy.get_time()

    def run(self) -> Outcome:
        missed: List[int] = []
        reason = ""
        for number, drive in enumerate(self._drives):
            self._number = number
            if self._is_cancelled.is_set():
                drive.cancel()
            outcome = drive.run()
            if outcome.success:
                continue
            missed.append(self._number)
            reason = reason or f"waypoint {self._number}: {outcome.reason}"
            if outcome.result is Result.CANCELLED or self._stop_on_failure:
                missed.extend(range(self._number + 1, len(self._drives)))
                return Outcome(outcome.result, reason, tuple(missed))
        count = len(self._drives)
        if missed:
            text = f"{count - len(missed)} of {count} waypoints reached; {reason}"
            return Outcome(Result.FAILED, text, tuple(missed))
        return Outcome(Result.SUCCEEDED, f"{count} waypoints reached")

    def cancel(self) -> None:
        super().cancel()
        self._drives[self._number].cancel()

    def feedback(self) -> Feedback:
        current = self._drives[self._number].feedback()
        return Feedback(self._seconds, current.left, current.pose, self._number)


class Motion:
    """What short motions need: odometry, the local costmap, and the way to the wheels."""

    def __init__(self) -> None:
        self.base_in_odom: Optional[Pose2] = None
        self.seen_at = 0.0
        self._grid: Optional[OccupancyGrid] = None
        self._lock = threading.Lock()
        self._commands = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        costmap = "move_base/local_costmap/costmap"
        rospy.Subscriber("odom", Odometry, self._keep_pose, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber(costmap, OccupancyGridArrays, self._keep_grid, queue_size=1)
        rospy.Subscriber(costmap + "_updates", OccupancyGridUpdate, self._update_grid, queue_size=10)

    def turn(self, angle: float, speed: float, timeout: float) -> "Stretch":
        return Stretch(self, angle, speed, timeout, is_turn=True)

    def back(self, distance: float, speed: float, timeout: float) -> "Stretch":
        return Stretch(self, -abs(distance), speed, timeout, is_turn=False)

    def command(self, linear: float, angular: float) -> None:
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        self._commands.publish(message)

    def is_blocked(self, pose: Pose2) -> bool:
        """Whether the local costmap, which is in the odometry's frame, shows an obstacle there."""
        with self._lock:
            if self._grid is None:
                return False
            cell = self._grid.cells_of([[pose.x, pose.y]])
            return bool(self._grid.contains(cell)[0] and self._grid.cells[tuple(cell[0])] >= INSCRIBED)

    def _keep_pose(self, message) -> None:
        self.base_in_odom, self.seen_at = pose2_from_msg(message.pose.pose), time.monotonic()

    def _keep_grid(self, message) -> None:
        with self._lock:
            grid = grid_from_msg(message)
            self._grid = OccupancyGrid(np.array(grid.cells), grid.resolution, grid.origin)

    def _update_grid(self, message) -> None:
        with self._lock:
            if self._grid is not None:
                rows, cols = (
                    slice(message.y, message.y + message.height),
                    slice(message.x, message.x + message.width),
                )
                part = np.array(message.data, dtype=np.int8).reshape(message.height, message.width)
                self._grid.cells[rows, cols] = part


class Stretch(Task):
    """A turn on the spot (radians) or a straight way (metres), measured by odometry."""

    LOOK_AHEAD = 0.2

    def __init__(self, motion: Motion, amount: float, speed: float, timeout: float, is_turn: bool):
        super().__init__(timeout)
        self._motion, self._amount, self._speed, self._is_turn = motion, amount, abs(speed), is_turn
        self._latest: Optional[Pose2] = None
        self._done = 0.0

    def run(self) -> Outcome:
        if not math.isfinite(self._amount) or not 0.0 < self._speed < math.inf:
            return Outcome(Result.FAILED, "the way and the speed must be numbers, the speed not zero")
        self._motion.seen_at = time.monotonic()
        try:
            return self._wait(self._move)
        finally:
            self._motion.command(0.0, 0.0)

    def feedback(self) -> Feedback:
        return Feedback(self._seconds, abs(self._amount - self._done), self._motion.base_in_odom)

    def _move(self) -> Optional[Outcome]:
        if time.monotonic() - self._motion.seen_at > PATIENCE_SECONDS:
            return Outcome(Result.FAILED, f"no odometry on {rospy.resolve_name('odom')}")
        pose = self._motion.base_in_odom
        if pose is None:
            return None
        self._note(pose)
        left = self._amount - self._done
        direction = math.copysign(1.0, self._amount)
        if left * direction <= 0.01:
            return Outcome(Result.SUCCEEDED, f"{'turned' if self._is_turn else 'drove'} {self._done:.2f}")
        ahead = Pose2(direction * min(self.LOOK_AHEAD, abs(left)), 0.0)
        if not self._is_turn and self._motion.is_blocked(pose @ ahead):
            return Outcome(Result.FAILED, f"an obstacle is in the way, {abs(left):.2f} m before the end")
        velocity = direction * min(self._speed, SLOW_DOWN * abs(left))
        self._motion.command(*((0.0, velocity) if self._is_turn else (velocity, 0.0)))
        return None

    def _note(self, pose: Pose2) -> None:
        if self._latest is not None:
            step = self._latest.inverse() @ pose
            self._done += float(wrap(step.yaw)) if self._is_turn else step.x
        self._latest = pose
