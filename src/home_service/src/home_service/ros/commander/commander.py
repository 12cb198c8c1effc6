"""Python client of move_base, ours or the official one.

    robot = Commander()
    if not robot.is_ready(timeout=30.0):
        raise SystemExit(f"waiting for {', '.join(robot.waiting_for)}")
    robot.go_to(2.0, 3.0)
    outcome = robot.wait()
    print(outcome.result, outcome.reason)

A command returns at once and cancels the one before. Every command ends by its time-out, and earlier if the
clock, the odometry or move_base is lost.
"""

import threading
import time
from pathlib import Path
from typing import Callable, Dict, Iterable, List, Optional, Sequence

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from std_srvs.srv import Empty

from home_service.ros.commander.motions import MotionInterface
from home_service.ros.commander.navigation import GoalTask, WaypointsTask
from home_service.ros.commander.outcomes import Feedback, Outcome
from home_service.ros.commander.task import CommanderTask
from planar import PlanarError, Pose2
from planar_ros.calls.load_map import LoadMap, LoadMapResult
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.calls.services import call_service
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.node.runner import init_node, shut_down_on_signals
from planar_ros.node.topics import has_all_subscribers
from rospy_transport.node import is_initialized, is_wall_clock

POLL_SECONDS = 0.05
# Variances of an initial pose, as set by rviz [m^2, m^2, rad^2].
INITIAL_POSE_VARIANCES = (0.25, 0.25, 0.0685)
LOCALIZED_DISTANCE = 0.5
MAP_ERRORS = {
    LoadMapResult.MAP_DOES_NOT_EXIST: "there is no such map",
    LoadMapResult.INVALID_MAP_DATA: "its image cannot be read",
    LoadMapResult.INVALID_MAP_METADATA: "its description cannot be read",
}


class CommanderError(PlanarError):
    """A command cannot be given."""


class Commander:
    """Commands for a robot. Poses are in metres and radians in ``frame_id``, time limits in ROS time.

    Args:
        name: Name of the node, unless the process is a node already.
        frame_id: Frame of all poses.
        base_frame_id: Frame of the robot.

    Attributes:
        waiting_for: What ``is_ready`` was still waiting for.
    """

    def __init__(self, name: str = "commander", frame_id: str = "map", base_frame_id: str = "base_footprint"):
        if not is_initialized():
            shut_down_on_signals(goes_on=True)
            init_node(name, anonymous=True)
        self.waiting_for: List[str] = []
        self._frame_id, self._base_frame_id = frame_id, base_frame_id
        self._task: Optional[CommanderTask] = None
        self._worker: Optional[threading.Thread] = None
        self._outcome: Optional[Outcome] = None
        self._move_base = MoveBaseClient(frame_id)
        self._transforms = Transforms()
        self._initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        self._motion = MotionInterface()

    def is_ready(self, timeout: float = 30.0) -> bool:
        """Wait until commands can be given.

        Args:
            timeout: Wall-clock time to wait [s].

        Returns:
            Whether commands can be given; ``waiting_for`` lists what is missing.
        """
        conditions: Dict[str, Callable[[], bool]] = {
            "a node that has started after /use_sim_time was set": _has_right_clock,
            "the clock": lambda: not rospy.Time.now().is_zero(),
            self._move_base.name: self._move_base.is_ready,
            f"the transform {self._frame_id} to {self._base_frame_id}": lambda: self.pose is not None,
        }
        deadline = time.monotonic() + timeout
        while True:
            self.waiting_for = [name for name, is_met in conditions.items() if not is_met()]
            if not self.waiting_for or rospy.is_shutdown() or time.monotonic() > deadline:
                return not self.waiting_for
            time.sleep(POLL_SECONDS)

    @property
    def pose(self) -> Optional[Pose2]:
        """Estimated pose of the robot; None if it is not known."""
        return self._transforms.lookup(self._frame_id, self._base_frame_id)

    def go_to(self, x: float, y: float, yaw: float = 0.0, timeout: float = 180.0) -> None:
        """Drive to a pose.

        Args:
            x: Position [m].
            y: Position [m].
            yaw: Heading [rad].
            timeout: Time limit [s].
        """
        self._begin(GoalTask(self._move_base, Pose2(x, y, yaw), timeout))

    def follow_waypoints(
        self, poses: Iterable[Sequence[float]], stop_on_failure: bool = False, timeout: float = 180.0
    ) -> None:
        """Drive to poses one after the other.

        Args:
            poses: Poses (x, y, yaw).
            stop_on_failure: End at the first pose that is not reached.
            timeout: Time limit for each pose [s].

        Raises:
            CommanderError: If there are no poses.
        """
        drives = [GoalTask(self._move_base, Pose2(*pose), timeout) for pose in poses]
        if not drives:
            raise CommanderError("there are no waypoints to follow")
        self._begin(WaypointsTask(drives, stop_on_failure))

    def spin(self, angle: float, speed: float = 0.8, timeout: float = 60.0) -> None:
        """Turn in place, measured by odometry.

        Args:
            angle: Angle, counter-clockwise if positive [rad].
            speed: Maximum speed [rad/s].
            timeout: Time limit [s].
        """
        self._begin(self._motion.spin(angle, speed, timeout))

    def back_up(self, distance: float, speed: float = 0.15, timeout: float = 60.0) -> None:
        """Drive straight back, measured by odometry, unless the local costmap shows an obstacle there.

        Args:
            distance: Distance [m].
            speed: Maximum speed [m/s].
            timeout: Time limit [s].
        """
        self._begin(self._motion.back_up(distance, speed, timeout))

    def cancel(self) -> None:
        """Cancel the command in progress; its outcome is CANCELLED."""
        if self._task is not None:
            self._task.cancel()

    def is_done(self) -> bool:
        """Whether the latest command has ended."""
        return self._worker is None or not self._worker.is_alive()

    def wait(self, timeout: Optional[float] = None) -> Outcome:
        """Wait for the outcome of the latest command.

        Args:
            timeout: Wall-clock time after which the command is cancelled [s]; None: its own time limit.
        """
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.is_done():
            if rospy.is_shutdown() or (deadline is not None and time.monotonic() > deadline):
                self.cancel()
                deadline = None
            time.sleep(POLL_SECONDS)
        return self.outcome()

    def feedback(self) -> Feedback:
        """Return the progress of the latest command."""
        if self._task is None:
            raise CommanderError("no command was given yet")
        return self._task.feedback()

    def outcome(self) -> Outcome:
        """Return the outcome of the latest command.

        Raises:
            CommanderError: If there is none yet.
        """
        if self._task is None:
            raise CommanderError("no command was given yet")
        if self._outcome is None or not self.is_done():
            raise CommanderError("the command has not ended yet")
        return self._outcome

    def set_initial_pose(self, x: float, y: float, yaw: float = 0.0, timeout: float = 10.0) -> None:
        """Set the pose estimate and wait until localization has adopted it.

        Args:
            x: Position [m].
            y: Position [m].
            yaw: Heading [rad].
            timeout: Wall-clock time to wait [s].

        Raises:
            CommanderError: If localization does not adopt the pose in time.
        """
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.header.stamp = self._frame_id, rospy.Time.now()
        message.pose.pose = pose2_to_msg(Pose2(x, y, yaw))
        covariance = [0.0] * 36
        covariance[0], covariance[7], covariance[35] = INITIAL_POSE_VARIANCES
        message.pose.covariance = covariance
        deadline = time.monotonic() + timeout
        topic = rospy.resolve_name("initialpose")
        self._wait_until(
            lambda: has_all_subscribers(self._initial_pose), deadline, f"no node subscribes to {topic}"
        )
        self._initial_pose.publish(message)
        reason = f"localization has not adopted the pose published on {topic} within {timeout:g} s"
        self._wait_until(lambda: self._is_localized_at(Pose2(x, y, yaw)), deadline, reason)

    def clear_costmaps(self, timeout: float = 10.0) -> None:
        """Clear the costmaps of move_base.

        Raises:
            ServiceError: If move_base does not answer.
        """
        call_service("move_base/clear_costmaps", Empty, Empty._request_class(), timeout)

    def change_map(self, path, timeout: float = 20.0) -> None:
        """Load another map into map_server.

        Raises:
            ServiceError: If map_server does not answer.
            CommanderError: If it cannot load the map.
        """
        if LoadMap is None:
            raise CommanderError("nav_msgs of this system has no LoadMap, with which maps are changed")
        request = LoadMap._request_class(map_url=str(Path(path).resolve()))
        response = call_service("change_map", LoadMap, request, timeout)
        if response.result != LoadMapResult.SUCCESS:
            raise CommanderError(f"{path}: {MAP_ERRORS.get(response.result, 'map_server refuses it')}")

    def _is_localized_at(self, pose: Pose2) -> bool:
        estimate = self.pose
        return estimate is not None and estimate.distance_to(pose) < LOCALIZED_DISTANCE

    @staticmethod
    def _wait_until(is_so: Callable[[], bool], deadline: float, complaint: str) -> None:
        while not is_so():
            if time.monotonic() > deadline or rospy.is_shutdown():
                raise CommanderError(complaint)
            time.sleep(POLL_SECONDS)

    def _begin(self, task: CommanderTask) -> None:
        if not self.is_done():
            self.cancel()
            self.wait()
        self._task, self._outcome = task, None
        self._worker = threading.Thread(target=self._work, args=(task,), daemon=True)
        self._worker.start()

    def _work(self, task: CommanderTask) -> None:
        self._outcome = task.run()


def _has_right_clock() -> bool:
    """Whether rospy, which decides once at its start, uses the clock of the other nodes."""
    return not (is_wall_clock() and rospy.get_param("/use_sim_time", False))
