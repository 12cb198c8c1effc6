"""A person at the keyboard: sees the robot's scan and where it truly is, drives it, waits, and tells."""

import math
import threading
import time
from pathlib import Path
from typing import Callable, List, Optional, Tuple

import rosgraph
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from planar import PlanarError, Pose2
from planar_ros.messages.conversion import pose2_from_msg
from run_project.course.checks import CheckResults

POLL_SECONDS = 0.05
# Seconds of wall time in which the robot has to be there, and in which so much simulated time has to pass.
BRING_UP_SECONDS = 120.0
WALL_PER_SIMULATED_SECOND = 20.0
# Half of the sector, radians, that has to be free to go that way; metres where there is no laser to ask.
SECTOR = math.radians(15.0)
DEFAULT_FREE_DISTANCE = 2.0


class UserTimeoutError(PlanarError):
    """What a person waited for did not come; the text says what."""


class ScriptedUser:
    """Does something with the robot in a thread of its own; ``say`` is told what came of it."""

    def __init__(
        self, procedure: Callable[["ScriptedUser"], None], folder: Path, log_event: Callable[[str], None]
    ):
        self.results = CheckResults()
        self.folder = folder
        self.is_done = False
        # Metres and radians that the robot has truly moved.
        self.total_motion = 0.0
        self._log_event = log_event
        self._procedure = procedure
        self._is_over = threading.Event()
        self._base: Optional[Pose2] = None
        self._scan: Optional[LaserScan] = None
        self._scan_subscriber: Optional[rospy.Subscriber] = None
        self._velocity_publisher: Optional[rospy.Publisher] = None
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """This process is a node by then."""
        rospy.Subscriber("/base_pose_ground_truth", Odometry, self._on_ground_truth, queue_size=5)
        self._thread.start()

    def stop(self) -> None:
        """Gives up whatever is under way."""
        self._is_over.set()
        if self._thread.ident is not None:
            self._thread.join(2.0)

    def log(self, told: str) -> None:
        """News that decide nothing."""
        self._log_event(f"{rospy.get_time():7.1f} s  {told}")

    def add_check(self, is_good: bool, told: str) -> None:
        self.log(self.results.add(is_good, told))

    @property
    def base(self) -> Pose2:
        """Where the robot truly is."""
        assert self._base is not None
        return self._base

    def wait_for_robot(self) -> None:
        self.wait(lambda: self._base is not None, BRING_UP_SECONDS, "no robot was spawned", is_wall=True)
        topic = self.find_topic("sensor_msgs/LaserScan")
        if topic:
            self._scan_subscriber = rospy.Subscriber(topic, LaserScan, self._on_scan, queue_size=1)

    def wait(
        self, is_so: Callable[[], bool], seconds: float, otherwise: str = "", is_wall: bool = False
    ) -> bool:
        """Whether it became so within simulated seconds. Raises GivenUpError if ``otherwise`` is given."""
        started, patience = (
            rospy.get_time(),
            time.monotonic() + seconds * (1.0 if is_wall else WALL_PER_SIMULATED_SECOND),
        )
        while not is_so():
            if self._is_over.wait(POLL_SECONDS):
                raise UserTimeoutError("interrupted")
            is_late = not is_wall and rospy.get_time() - started > seconds
            if is_late or time.monotonic() > patience:
                if otherwise:
                    raise UserTimeoutError(f"{otherwise} within {seconds:g} s")
                return False
        return True

    def sleep(self, seconds: float) -> None:
        """Lets simulated time pass."""
        end = rospy.get_time() + seconds
        self.wait(lambda: rospy.get_time() >= end, seconds + 1.0)

    def free_distance(self, bearing: float) -> float:
        """Metres that are free in that direction, radians from where the robot looks."""
        scan = self._scan
        if scan is None:
            return DEFAULT_FREE_DISTANCE
        distances = [
            distance if math.isfinite(distance) else scan.range_max
            for number, distance in enumerate(scan.ranges)
            if abs(_wrapped(scan.angle_min + number * scan.angle_increment - bearing)) < SECTOR
        ]
        return min(distances, default=0.0)

    def bearing_with_most_space(self) -> float:
        """The bearing with most room, radians; straight ahead if that is as good."""
        bearings = [0.0, *(sign * math.radians(step) for step in range(10, 180, 10) for sign in (1, -1))]
        return max(bearings, key=lambda bearing: self.free_distance(bearing))

    def drive(self, v: float, omega: float) -> None:
        """Steers with the keyboard."""
        if self._velocity_publisher is None:
            topic = self._velocity_topic() or "/cmd_vel"
            self._velocity_publisher = rospy.Publisher(topic, Twist, queue_size=1)
        command = Twist()
        command.linear.x, command.angular.z = v, omega
        self._velocity_publisher.publish(command)

    def find_topic(self, kind: str, without: str = "\0") -> Optional[str]:
        """A topic of that type that somebody publishes, the one with the shortest name."""
        topics = [
            topic for topic, type_ in rospy.get_published_topics() if type_ == kind and without not in topic
        ]
        return min(topics, key=len) if topics else None

    def has_node(self, name: str) -> bool:
        """Whether a node runs whose name holds that."""
        return any(name in node for _, nodes in self._state()[1] for node in nodes)

    def _velocity_topic(self) -> Optional[str]:
        subscribed = {topic for topic, nodes in self._state()[1] if "/gazebo" in nodes}
        kinds = dict(rosgraph.Master("/person").getTopicTypes())
        topics = [topic for topic in subscribed if kinds.get(topic) == "geometry_msgs/Twist"]
        return min(topics, key=len) if topics else None

    def _state(self) -> Tuple[List, List, List]:
        return rosgraph.Master("/person").getSystemState()

    def _on_ground_truth(self, message: Odometry) -> None:
        base = pose2_from_msg(message.pose.pose)
        if self._base is not None:
            self.total_motion += base.distance_to(self._base) + abs(_wrapped(base.yaw - self._base.yaw))
        self._base = base

    def _on_scan(self, message: LaserScan) -> None:
        self._scan = message

    def _run(self) -> None:
        try:
            self.wait_for_robot()
            self._procedure(self)
        except (PlanarError, rospy.ROSException, rospy.ServiceException, OSError) as error:
            if not self._is_over.is_set():
                self.add_check(False, str(error))
        finally:
            self.is_done = True


def _wrapped(angle: float) -> float:
    return (angle + math.pi) % math.tau - math.pi
