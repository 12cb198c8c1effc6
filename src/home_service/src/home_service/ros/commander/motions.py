"""Short motions measured by odometry: turn in place, drive straight back."""

import math
import threading
import time
from typing import Optional

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import Odometry

from home_service.ros.commander.outcomes import Feedback, Outcome, Result
from home_service.ros.commander.task import PATIENCE_SECONDS, CommanderTask
from planar import OccupancyGrid, Pose2, wrap
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg, pose2_from_msg
from planar_ros.messages.validation import subscribe

# Maximum speed per remaining distance or angle [1/s].
SLOW_DOWN = 1.5
# Cost in a published costmap from which on a cell is too close to an obstacle for the robot's centre.
INSCRIBED = 99


class MotionInterface:
    """Odometry, local costmap and velocity commands for short motions.

    Attributes:
        base_in_odom: Latest pose of the base in odom.
        seen_at: Monotonic time of the latest odometry [s].
    """

    def __init__(self) -> None:
        self.base_in_odom: Optional[Pose2] = None
        self.seen_at = 0.0
        self._grid: Optional[OccupancyGrid] = None
        self._lock = threading.Lock()
        self._commands = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        costmap = "move_base/local_costmap/costmap"
        subscribe("odom", Odometry, self._on_pose, queue_size=1, tcp_nodelay=True)
        subscribe(costmap, OccupancyGridArrays, self._on_grid, queue_size=1)
        rospy.Subscriber(costmap + "_updates", OccupancyGridUpdate, self._on_grid_update, queue_size=10)

    def spin(self, angle: float, speed: float, timeout: float) -> "MotionTask":
        return MotionTask(self, angle, speed, timeout, is_turn=True)

    def back_up(self, distance: float, speed: float, timeout: float) -> "MotionTask":
        return MotionTask(self, -abs(distance), speed, timeout, is_turn=False)

    def publish_velocity(self, linear: float, angular: float) -> None:
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        self._commands.publish(message)

    def is_blocked(self, pose: Pose2) -> bool:
        """Whether the local costmap, which is in the odometry frame, shows an obstacle at a pose."""
        with self._lock:
            if self._grid is None:
                return False
            cell = self._grid.cells_of([[pose.x, pose.y]])
            return bool(self._grid.contains(cell)[0] and self._grid.cells[tuple(cell[0])] >= INSCRIBED)

    def _on_pose(self, message) -> None:
        self.base_in_odom, self.seen_at = pose2_from_msg(message.pose.pose), time.monotonic()

    def _on_grid(self, message) -> None:
        with self._lock:
            grid = grid_from_msg(message)
            self._grid = OccupancyGrid(np.array(grid.cells), grid.resolution, grid.origin)

    def _on_grid_update(self, message) -> None:
        with self._lock:
            if self._grid is not None:
                rows, cols = (
                    slice(message.y, message.y + message.height),
                    slice(message.x, message.x + message.width),
                )
                part = np.array(message.data, dtype=np.int8).reshape(message.height, message.width)
                self._grid.cells[rows, cols] = part


class MotionTask(CommanderTask):
    """A turn in place [rad] or a straight motion [m]."""

    LOOK_AHEAD = 0.2

    def __init__(self, motion: MotionInterface, amount: float, speed: float, timeout: float, is_turn: bool):
        super().__init__(timeout)
        self._motion, self._amount, self._speed, self._is_turn = motion, amount, abs(speed), is_turn
        self._latest: Optional[Pose2] = None
        self._done = 0.0

    def run(self) -> Outcome:
        if not math.isfinite(self._amount) or not 0.0 < self._speed < math.inf:
            return Outcome(Result.FAILED, "distance and speed must be finite, and speed not zero")
        self._motion.seen_at = time.monotonic()
        try:
            return self._wait(self._move)
        finally:
            self._motion.publish_velocity(0.0, 0.0)

    def feedback(self) -> Feedback:
        return Feedback(self._seconds, abs(self._amount - self._done), self._motion.base_in_odom)

    def _move(self) -> Optional[Outcome]:
        if time.monotonic() - self._motion.seen_at > PATIENCE_SECONDS:
            return Outcome(Result.FAILED, f"no odometry on {rospy.resolve_name('odom')}")
        pose = self._motion.base_in_odom
        if pose is None:
            return None
        self._update_progress(pose)
        left = self._amount - self._done
        direction = math.copysign(1.0, self._amount)
        if left * direction <= 0.01:
            return Outcome(Result.SUCCEEDED, f"{'turned' if self._is_turn else 'drove'} {self._done:.2f}")
        ahead = Pose2(direction * min(self.LOOK_AHEAD, abs(left)), 0.0)
        if not self._is_turn and self._motion.is_blocked(pose @ ahead):
            return Outcome(Result.FAILED, f"blocked by an obstacle {abs(left):.2f} m before the end")
        velocity = direction * min(self._speed, SLOW_DOWN * abs(left))
        self._motion.publish_velocity(*((0.0, velocity) if self._is_turn else (velocity, 0.0)))
        return None

    def _update_progress(self, pose: Pose2) -> None:
        if self._latest is not None:
            step = self._latest.inverse() @ pose
            self._done += float(wrap(step.yaw)) if self._is_turn else step.x
        self._latest = pose
