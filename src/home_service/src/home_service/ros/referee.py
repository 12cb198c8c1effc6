"""Watches a run from outside the robot: ground truth, contacts, the state of the errand, the marker."""

import contextlib
import math
import re
import threading
import time
from collections import deque
from typing import Any, Callable, Deque, Dict, Mapping, Optional, Set, Tuple

from home_service_msgs.msg import DeliverActionGoal, MissionState
from move_base_msgs.msg import MoveBaseActionResult
from nav_msgs.msg import Odometry, Path
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from home_service.judging.delivery_watch import DeliveryWatch
from home_service.judging.marker_log import MarkerLog, Shown
from home_service.judging.verdict import FINAL_STATES, Ledger, Verdict, collision, judge
from home_service.ros.goal_watch import GoalWatch
from home_service.ros.hearing import hear
from pick_objects import Delivery, Stage, parse_mission
from planar import PlanarError, Pose2
from planar.maps.places import NamedPlace
from planar_ros.messages.conversion import pose2_from_msg
from supervision.processes import start_of_this_process

MOTION_DISTANCE = 0.02
NUMBER = re.compile(r"\d[\d.]*")
CONNECTION_CHATTER = "tcpros_base.py"
# Ground truth is remembered for so many messages, to look up where the robot stood at a stamp.
REMEMBERED = 500
SPOKEN_NODES = ("/pick_objects", "/add_markers")
# Of simulated and of wall time, after the end of a mission: what has not been told by then does not come.
LATE_SECONDS = 10.0


class Referee:
    """A judge that fills a ledger from topics. Simulated time is that of the ground truth's stamps.

    ``say`` is called with each line worth a person's attention. Places that only a mission knows which the
    robot is sent are learned from it.
    """

    def __init__(
        self, places: Mapping[str, NamedPlace], say: Callable[[str], None], tells_goals: bool = False
    ):
        """``tells_goals``: also of the goals that move_base is given."""
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
        self._places = dict(places)
        self._say = say
        self._recent: Deque[Tuple[float, Pose2]] = deque(maxlen=REMEMBERED)
        self._unjudged: Deque[MissionState] = deque()
        self._deliveries = DeliveryWatch(self._places, self.ledger.deliveries, say)
        self._markers = MarkerLog(self._places, self.ledger)
        self._told: Set[str] = set()
        self._lock = threading.Lock()
        self._has_started = False
        # Simulated and wall time of the end of the mission, once it has come.
        self._over_since: Optional[Tuple[float, float]] = None
        self._goals = GoalWatch(say, lambda: self.truth) if tells_goals else None

    def start(self) -> None:
        """Subscribes to what it judges by; this process is a node by then."""
        self._has_started = True
        truth = "base_pose_ground_truth"
        hear(truth, Odometry, self._see_truth)
        hear("contacts", String, self._see_contact)
        hear("pick_objects/state", String, self._see_state)
        hear("deliver/goal", DeliverActionGoal, self._see_goal)
        hear("pick_objects/mission_state", MissionState, self._see_mission)
        hear("visualization_marker", Marker, self._see_marker)
        hear("move_base/NavfnROS/plan", Path, self._see_plan)
        hear("move_base/result", MoveBaseActionResult, self._see_result)
        hear("/rosout_agg", Log, self._hear)
        if self._goals is not None:
            self._goals.start()

    def has_begun(self) -> bool:
        """Whether the truth about the robot has been seen."""
        return self.truth is not None

    def has_seen(self, expected: Set[str]) -> bool:
        """Whether everything expected has been seen, or can no longer come."""
        return self.ledger.is_complete(expected) or self._is_long_over()

    def verdict(self, expected: Set[str], failure: Optional[str] = None) -> Verdict:
        """Whether all that was expected truly came about; ``failure``: why the run was cut short, if so."""
        self.ledger.failure = failure or self.ledger.failure
        return judge(self.ledger, expected)

    def distance_from(self, pose: Pose2) -> float:
        """How far the robot truly is from a pose of the world, metres; it has begun by then."""
        assert self.truth is not None
        return self.truth.distance_to(pose)

    @property
    def collision(self) -> Optional[str]:
        """What the robot has collided with, in words; None if with nothing."""
        return collision(self.ledger.collisions)

    def status(self) -> str:
        """How things stand, in a line."""
        to_go = "" if self.distance_to_go is None else f"{self.distance_to_go:.1f} m to go, "
        return (
            f"{self.state or 'running'}: {to_go}simulated {self.simulated_seconds:.1f} s, "
            f"{self.real_time_factor:.1f} x real time"
        )

    def findings(self) -> Dict[str, Any]:
        """What belongs into result.json; nothing if it was not started."""
        if not self._has_started:
            return {}
        first_motion = self.first_motion_wall
        return {
            "first_motion_wall_seconds": first_motion and round(first_motion - start_of_this_process(), 3),
            "simulated_seconds": round(self.simulated_seconds, 3),
            "real_time_factor": round(self.real_time_factor, 3),
            "distance_driven": round(self.distance_driven, 3),
            **self.ledger.findings(),
            **({} if self._goals is None else self._goals.findings()),
        }

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
            self._recent.append((stamp, truth))
            self._judge_missions()
            has_moved = self._start_truth.distance_to(truth) > MOTION_DISTANCE
            if self.first_motion_wall is None and has_moved:
                self.first_motion_wall = time.time()

    def _see_state(self, message):
        with self._lock:
            self.state = message.data

    def _see_goal(self, message):
        """What cannot be understood is refused by the robot, in words."""
        with self._lock, contextlib.suppress(PlanarError):
            if message.goal.mission:
                self._places.update(parse_mission(message.goal.mission, self._places).places)

    def _see_mission(self, message):
        with self._lock:
            self._unjudged.append(message)
            self._judge_missions()

    def _judge_missions(self):
        """Judges what has been told of missions, each once the truth of its moment has come."""
        while self._unjudged and self._unjudged[0].header.stamp.to_sec() <= self.simulated_time:
            message = self._unjudged.popleft()
            truth = self._truth_at(message.header.stamp.to_sec())
            for state in message.deliveries:
                told = state.delivery
                delivery = Delivery(told.name, told.object, told.source, told.destination)
                self._deliveries.see(delivery, Stage(state.state), state.attempts, state.reason, truth)
            self.ledger.reason, self.ledger.final_state = message.reason, message.state
            self._markers.tell()
        if self.ledger.final_state not in FINAL_STATES:
            self._over_since = None
        elif self._over_since is None:
            self._over_since = (self.simulated_time, time.monotonic())

    def _is_long_over(self) -> bool:
        now = (self.simulated_time, time.monotonic())
        return self._over_since is not None and all(
            moment > since + LATE_SECONDS for moment, since in zip(now, self._over_since)
        )

    def _truth_at(self, stamp: float) -> Optional[Pose2]:
        if not self._recent:
            return None
        return min(self._recent, key=lambda entry: abs(entry[0] - stamp))[1]

    def _see_contact(self, message):
        for name in message.data.splitlines():
            self.ledger.collisions.append(name)
            self._say(f"collision with {name}")

    def _see_marker(self, message):
        is_hidden = message.action == Marker.DELETE
        pose = Pose2() if is_hidden else pose2_from_msg(message.pose)
        with self._lock:
            self._markers.see(Shown(message.ns, pose, message.frame_locked, is_hidden))

    def _see_plan(self, message):
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
        self.distance_to_go = sum(math.dist(a, b) for a, b in zip(points, points[1:]))

    def _see_result(self, _message):
        """A goal is over: there is nothing left to go."""
        self.distance_to_go = None

    def _hear(self, message):
        if message.file == CONNECTION_CHATTER:
            return
        node = message.name.lstrip("/")
        if message.level >= Log.WARN:
            if self._is_news(f"{node}: {NUMBER.sub('', message.msg)}"):
                self._say(f"{node}: warning: {message.msg}")
        elif message.name in SPOKEN_NODES:
            self._say(f"{node}: {message.msg}")

    def _is_news(self, gist):
        """Whether this was not told before, be it with other numbers; the report counts them all."""
        is_news = gist not in self._told
        self._told.add(gist)
        return is_news
