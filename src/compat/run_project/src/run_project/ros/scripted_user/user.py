"""Scripted user: drives the robot by its scan and true pose, waits, and checks the result."""

import math
import threading
import time
from pathlib import Path
from typing import Callable, List, Optional, Tuple

import rosgraph
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from evaluation.event_stream import EventStream
from evaluation.events import TruthUpdated
from planar import PlanarError, Pose2
from run_project.course.checks import CheckResults
from run_project.judging.map_alignment import MapAlignment

POLL_SECONDS = 0.05
# Wall time for the robot to be spawned [s], and wall time allowed for a simulated second [s].
BRING_UP_SECONDS = 120.0
WALL_PER_SIMULATED_SECOND = 20.0
# Half of the sector evaluated for a free distance [rad], and the distance assumed without a laser [m].
SECTOR = math.radians(15.0)
DEFAULT_FREE_DISTANCE = 2.0


class UserTimeoutError(PlanarError):
    """An expected condition did not occur in time; the text states which."""


class ScriptedUser:
    """Runs a procedure with the robot in a thread and collects its checks.

    Attributes:
        results: Checks of the procedure.
        folder: Run folder.
        is_done: Whether the procedure has ended.
        total_motion: True motion of the robot, metres plus radians.
        alignment: Where the map's frame lies in the world.
    """

    def __init__(
        self, procedure: Callable[["ScriptedUser"], None], folder: Path, log_event: Callable[[str], None]
    ):
        self.results = CheckResults()
        self.folder = folder
        self.is_done = False
        self.total_motion = 0.0
        self.alignment = MapAlignment()
        self._log_event = log_event
        self._procedure = procedure
        self._is_over = threading.Event()
        self._base: Optional[Pose2] = None
        self._scan: Optional[LaserScan] = None
        self._scan_subscriber: Optional[rospy.Subscriber] = None
        self._velocity_publisher: Optional[rospy.Publisher] = None
        self._thread = threading.Thread(target=self._run, daemon=True)

    def attach(self, events: EventStream, alignment: MapAlignment) -> None:
        """Subscribe to events, and share the alignment of the run's record."""
        events.subscribe(TruthUpdated, self._on_truth)
        self.alignment = alignment

    def start(self) -> None:
        """Start the procedure. This process must be a ROS node."""
        self._thread.start()

    def stop(self) -> None:
        """Interrupt the procedure."""
        self._is_over.set()
        if self._thread.ident is not None:
            self._thread.join(2.0)

    def log(self, text: str) -> None:
        """Print an event that is not a check."""
        self._log_event(f"{rospy.get_time():7.1f} s  {text}")

    def add_check(self, passed: bool, description: str) -> None:
        """Add a check and print it."""
        self.log(self.results.add(passed, description))

    @property
    def base(self) -> Pose2:
        """True pose of the robot in the world."""
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
        """Wait for a condition.

        Args:
            is_so: The condition.
            seconds: Limit of simulated time [s].
            otherwise: What is missing if the condition does not occur.
            is_wall: Whether the limit is wall time.

        Returns:
            Whether the condition occurred.

        Raises:
            UserTimeoutError: It did not occur and ``otherwise`` is given, or the run was interrupted.
        """
        started, wall_limit = (
            rospy.get_time(),
            time.monotonic() + seconds * (1.0 if is_wall else WALL_PER_SIMULATED_SECOND),
        )
        while not is_so():
            if self._is_over.wait(POLL_SECONDS):
                raise UserTimeoutError("interrupted")
            is_over = not is_wall and rospy.get_time() - started > seconds
            if is_over or time.monotonic() > wall_limit:
                if otherwise:
                    raise UserTimeoutError(f"{otherwise} within {seconds:g} s")
                return False
        return True

    def sleep(self, seconds: float) -> None:
        """Wait for simulated time [s]."""
        end = rospy.get_time() + seconds
        self.wait(lambda: rospy.get_time() >= end, seconds + 1.0)

    def free_distance(self, bearing: float) -> float:
        """Shortest range around a bearing relative to the robot's heading [rad]; in metres."""
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
        """Bearing with the longest free distance [rad]; straight ahead if equal."""
        bearings = [0.0, *(sign * math.radians(step) for step in range(10, 180, 10) for sign in (1, -1))]
        return max(bearings, key=lambda bearing: self.free_distance(bearing))

    def drive(self, v: float, omega: float) -> None:
        """Publish a velocity command [m/s, rad/s], as keyboard teleoperation does."""
        if self._velocity_publisher is None:
            topic = self._velocity_topic() or "/cmd_vel"
            self._velocity_publisher = rospy.Publisher(topic, Twist, queue_size=1)
        command = Twist()
        command.linear.x, command.angular.z = v, omega
        self._velocity_publisher.publish(command)

    def find_topic(self, kind: str, without: str = "\0") -> Optional[str]:
        """The published topic of a message type with the shortest name; None if there is none."""
        topics = [
            topic for topic, type_ in rospy.get_published_topics() if type_ == kind and without not in topic
        ]
        return min(topics, key=len) if topics else None

    def has_node(self, name: str) -> bool:
        """Whether a node runs that has ``name`` in its name."""
        return any(name in node for _, nodes in self._state()[1] for node in nodes)

    def _velocity_topic(self) -> Optional[str]:
        subscribed = {topic for topic, nodes in self._state()[1] if "/gazebo" in nodes}
        kinds = dict(rosgraph.Master("/scripted_user").getTopicTypes())
        topics = [topic for topic in subscribed if kinds.get(topic) == "geometry_msgs/Twist"]
        return min(topics, key=len) if topics else None

    def _state(self) -> Tuple[List, List, List]:
        return rosgraph.Master("/scripted_user").getSystemState()

    def _on_truth(self, event: TruthUpdated) -> None:
        base = event.pose
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
