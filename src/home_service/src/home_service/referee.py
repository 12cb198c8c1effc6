"""Watches a run from outside the robot: ground truth, contacts, the state of the errand, the marker."""

import math
import threading
import time
from typing import Callable, Mapping, Optional

import rospy
from nav_msgs.msg import Odometry, Path
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from home_service.verdict import Ledger
from planar import Pose2
from planar.places import Place
from planar_ros.messages import pose2_from_msg

MOTION_DISTANCE = 0.02
CONNECTION_CHATTER = "tcpros_base.py"
SPOKEN_NODES = ("/pick_objects", "/add_markers")


class Referee:
    """Fills a ledger from topics. Simulated time is that of the ground truth's stamps.

    ``say`` is called with each line worth a person's attention.
    """

    def __init__(self, places: Mapping[str, Place], say: Callable[[str], None]):
        self.ledger = Ledger()
        self.state = ""
        self.distance_driven = 0.0
        self.distance_to_go: Optional[float] = None
        self.first_motion_wall: Optional[float] = None
        self.start_wall = 0.0
        self.truth: Optional[Pose2] = None
        self.simulated_time = 0.0
        self._start_truth = Pose2()
        self._start_time = 0.0
        self._places = places
        self._say = say
        self._lock = threading.Lock()
        rospy.Subscriber("base_pose_ground_truth", Odometry, self._see_truth, queue_size=50, tcp_nodelay=True)
        rospy.Subscriber("contacts", String, self._see_contact, queue_size=50)
        rospy.Subscriber("pick_objects/state", String, self._see_state, queue_size=10)
        rospy.Subscriber("visualization_marker", Marker, self._see_marker, queue_size=10)
        rospy.Subscriber("move_base/NavfnROS/plan", Path, self._see_plan, queue_size=1)
        rospy.Subscriber("/rosout_agg", Log, self._hear, queue_size=50)

    @property
    def simulated_seconds(self) -> float:
        """How long the simulation has run since it was first seen."""
        return self.simulated_time - self._start_time

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds per wall-clock second since the simulation was first seen."""
        if self.truth is None:
            return 0.0
        return self.simulated_seconds / max(time.monotonic() - self.start_wall, 1e-3)

    def _see_truth(self, message):
        truth, stamp = pose2_from_msg(message.pose.pose), message.header.stamp.to_sec()
        with self._lock:
            if self.truth is None:
                self._start_truth, self._start_time, self.start_wall = truth, stamp, time.monotonic()
            else:
                self.distance_driven += self.truth.distance_to(truth)
            self.truth, self.simulated_time = truth, stamp
            has_moved = self._start_truth.distance_to(truth) > MOTION_DISTANCE
            if self.first_motion_wall is None and has_moved:
                self.first_motion_wall = time.time()

    def _see_state(self, message):
        with self._lock:
            self.state = self.ledger.final_state = message.data
            arrived_at = {"picking up": "pickup", "delivered": "dropoff"}.get(message.data)
            if arrived_at in self._places and self.truth is not None:
                error = self.truth.distance_to(self._places[arrived_at].pose)
                self.ledger.errors[arrived_at] = error
                self._say(f"at {arrived_at}: truly {error:.3f} m from the zone's centre")

    def _see_contact(self, message):
        for name in message.data.splitlines():
            self.ledger.collisions.append(name)
            self._say(f"collision with {name}")

    def _see_marker(self, message):
        if not self._places:
            return
        if message.action == Marker.DELETE:
            event = "hidden"
        else:
            shown = pose2_from_msg(message.pose)
            nearest = min(self._places.values(), key=lambda place: place.pose.distance_to(shown))
            event = f"shown at {nearest.name}"
        if not self.ledger.markers or self.ledger.markers[-1] != event:
            self.ledger.markers.append(event)

    def _see_plan(self, message):
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
        self.distance_to_go = sum(math.dist(a, b) for a, b in zip(points, points[1:]))

    def _hear(self, message):
        if message.file == CONNECTION_CHATTER:
            return
        if message.level >= Log.WARN or message.name in SPOKEN_NODES:
            mark = "warning: " if message.level >= Log.WARN else ""
            self._say(f"{message.name.lstrip('/')}: {mark}{message.msg}")
