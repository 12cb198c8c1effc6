"""Observes a run from outside the robot: ground truth, contacts, mission state, markers."""

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

from evaluation.delivery_monitor import DeliveryMonitor
from evaluation.marker_log import MarkerLog, MarkerState
from evaluation.ros.goal_monitor import GoalMonitor
from evaluation.ros.subscriptions import subscribe
from evaluation.verdict import FINAL_STATES, MissionRecord, Verdict, collision, judge
from pick_objects import Delivery, DeliveryStage, parse_mission
from planar import PlanarError, Pose2
from planar.maps.places import NamedPlace
from planar_ros.messages.conversion import pose2_from_msg
from supervision.processes import start_of_this_process

MOTION_DISTANCE = 0.02
NUMBER = re.compile(r"\d[\d.]*")
CONNECTION_LOG_FILE = "tcpros_base.py"
# Ground-truth messages that are kept to look up the pose at a stamp.
TRUTH_HISTORY = 500
LOGGED_NODES = ("/pick_objects", "/add_markers")
# Simulated and wall-clock time after the end of a mission in which further messages are waited for [s].
GRACE_SECONDS = 10.0


class Referee:
    """Fills a mission record from topics. Simulated time is that of the ground truth's stamps.

    Args:
        places: Places by name; places of a mission that is sent to the robot are added.
        log: Called with each line for people.
        logs_goals: Log goals of move_base and their outcomes, too.
        idle_text: State in words while no mission is under way; empty: the last state.

    Attributes:
        mission_record: Observations of the run.
        state: Current state of the mission.
        distance_driven: True distance driven [m].
        first_motion_wall: Wall-clock time of the first motion [s].
        start_wall: Monotonic time of the first ground truth [s].
        truth: Latest true pose.
        simulated_time: Its stamp [s].
    """

    def __init__(
        self,
        places: Mapping[str, NamedPlace],
        log: Callable[[str], None],
        logs_goals: bool = False,
        idle_text: str = "",
    ):
        self.mission_record = MissionRecord()
        self.state = ""
        self.distance_driven = 0.0
        # True distance driven at the end of the latest plan [m]; None without a goal.
        self._plan_end: Optional[float] = None
        self.first_motion_wall: Optional[float] = None
        self.start_wall = 0.0
        self.truth: Optional[Pose2] = None
        self.simulated_time = 0.0
        self._start_truth = Pose2()
        self._start_time = 0.0
        self._places = dict(places)
        self._log = log
        self._idle_text = idle_text
        self._recent: Deque[Tuple[float, Pose2]] = deque(maxlen=TRUTH_HISTORY)
        self._pending_missions: Deque[MissionState] = deque()
        self._deliveries = DeliveryMonitor(self._places, self.mission_record.deliveries, log)
        self._markers = MarkerLog(self._places, self.mission_record)
        self._logged: Set[str] = set()
        self._lock = threading.Lock()
        self._is_started = False
        # Simulated and wall time of the end of the mission, once it has come.
        self._ended_at: Optional[Tuple[float, float]] = None
        self._goals = GoalMonitor(log, lambda: self.truth) if logs_goals else None

    def start(self) -> None:
        """Subscribe; this process is a node by then."""
        self._is_started = True
        subscribe("base_pose_ground_truth", Odometry, self._on_truth)
        subscribe("contacts", String, self._on_contact)
        subscribe("pick_objects/state", String, self._on_state)
        subscribe("deliver/goal", DeliverActionGoal, self._on_goal)
        subscribe("pick_objects/mission_state", MissionState, self._on_mission)
        subscribe("visualization_marker", Marker, self._on_marker)
        subscribe("move_base/NavfnROS/plan", Path, self._on_plan)
        subscribe("move_base/result", MoveBaseActionResult, self._on_result)
        subscribe("/rosout_agg", Log, self._on_log)
        if self._goals is not None:
            self._goals.start()

    def has_truth(self) -> bool:
        """Whether the true pose of the robot has been received."""
        return self.truth is not None

    def has_seen(self, expected: Set[str]) -> bool:
        """Whether everything expected has been observed, or can no longer occur."""
        return self.mission_record.is_complete(expected) or self._is_past_grace_period()

    def verdict(self, expected: Set[str], failure: Optional[str] = None) -> Verdict:
        """Return the verdict; ``failure``: why the run was cut short, if so."""
        self.mission_record.failure = failure or self.mission_record.failure
        return judge(self.mission_record, expected)

    def distance_from(self, pose: Pose2) -> float:
        """Return the true distance of the robot from a pose in the world [m]; requires ground truth."""
        assert self.truth is not None
        return self.truth.distance_to(pose)

    @property
    def collision(self) -> Optional[str]:
        """What the robot has collided with, in words; None if nothing."""
        return collision(self.mission_record.collisions)

    def status(self) -> str:
        """Return the current state in one line."""
        remaining = self.remaining_distance
        to_go = "" if remaining is None else f"{remaining:.1f} m to go, "
        return (
            f"{self._activity}: {to_go}simulated {self.simulated_seconds:.1f} s, "
            f"{self.real_time_factor:.1f} x real time"
        )

    @property
    def _activity(self) -> str:
        is_idle = self.state in ("", *FINAL_STATES)
        return (is_idle and self._idle_text) or self.state or "running"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none if it was not started."""
        if not self._is_started:
            return {}
        first_motion = self.first_motion_wall
        return {
            "first_motion_wall_seconds": first_motion and round(first_motion - start_of_this_process(), 3),
            "simulated_seconds": round(self.simulated_seconds, 3),
            "real_time_factor": round(self.real_time_factor, 3),
            "distance_driven": round(self.distance_driven, 3),
            **self.mission_record.result_fields(),
            **({} if self._goals is None else self._goals.result_fields()),
        }

    @property
    def remaining_distance(self) -> Optional[float]:
        """Length of the latest plan less the distance driven since [m]; None without a goal."""
        return None if self._plan_end is None else max(0.0, self._plan_end - self.distance_driven)

    @property
    def simulated_seconds(self) -> float:
        """Simulated time since the first ground truth [s]."""
        return self.simulated_time - self._start_time

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds per wall-clock second since the first ground truth."""
        if self.truth is None:
            return 0.0
        return self.simulated_seconds / max(time.monotonic() - self.start_wall, 1e-3)

    def _on_truth(self, message):
        truth, stamp = pose2_from_msg(message.pose.pose), message.header.stamp.to_sec()
        with self._lock:
            if stamp < self.simulated_time:
                self._on_reset_time()
            if self.truth is None:
                self._start_truth, self._start_time, self.start_wall = truth, stamp, time.monotonic()
            else:
                self.distance_driven += self.truth.distance_to(truth)
            self.truth, self.simulated_time = truth, stamp
            self._recent.append((stamp, truth))
            self._process_missions()
            has_moved = self._start_truth.distance_to(truth) > MOTION_DISTANCE
            if self.first_motion_wall is None and has_moved:
                self.first_motion_wall = time.time()

    def _on_reset_time(self):
        """Process what was published before time was set back, and drop the ground truth of that time."""
        self._process_missions(math.inf)
        self._recent.clear()

    def _on_state(self, message):
        with self._lock:
            self.state = message.data

    def _on_goal(self, message):
        """Add the places of a mission; the robot reports a mission that is not valid."""
        with self._lock, contextlib.suppress(PlanarError):
            if message.goal.mission:
                self._places.update(parse_mission(message.goal.mission, self._places).places)

    def _on_mission(self, message):
        with self._lock:
            self._pending_missions.append(message)
            self._process_missions()

    def _process_missions(self, until: Optional[float] = None):
        """Process mission states with stamps up to ``until``, by default up to that of the ground truth."""
        last = self.simulated_time if until is None else until
        while self._pending_missions and self._pending_missions[0].header.stamp.to_sec() <= last:
            message = self._pending_missions.popleft()
            truth = self._truth_at(message.header.stamp.to_sec())
            for state in message.deliveries:
                reported = state.delivery
                delivery = Delivery(reported.name, reported.object, reported.source, reported.destination)
                self._deliveries.update(
                    delivery, DeliveryStage(state.state), state.attempts, state.reason, truth
                )
            self.mission_record.reason, self.mission_record.final_state = message.reason, message.state
            self._markers.flush()
        if self.mission_record.final_state not in FINAL_STATES:
            self._ended_at = None
        elif self._ended_at is None:
            self._ended_at = (self.simulated_time, time.monotonic())

    def _is_past_grace_period(self) -> bool:
        now = (self.simulated_time, time.monotonic())
        return self._ended_at is not None and all(
            t > end + GRACE_SECONDS for t, end in zip(now, self._ended_at)
        )

    def _truth_at(self, stamp: float) -> Optional[Pose2]:
        if not self._recent:
            return None
        return min(self._recent, key=lambda entry: abs(entry[0] - stamp))[1]

    def _on_contact(self, message):
        for name in message.data.splitlines():
            self.mission_record.collisions.append(name)
            self._log(f"collision with {name}")

    def _on_marker(self, message):
        is_hidden = message.action == Marker.DELETE
        pose = Pose2() if is_hidden else pose2_from_msg(message.pose)
        with self._lock:
            self._markers.add(MarkerState(message.ns, pose, message.frame_locked, is_hidden))

    def _on_plan(self, message):
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
        length = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
        self._plan_end = self.distance_driven + length

    def _on_result(self, _message):
        """A goal has ended: no distance remains."""
        self._plan_end = None

    def _on_log(self, message):
        if message.file == CONNECTION_LOG_FILE:
            return
        node = message.name.lstrip("/")
        if message.level >= Log.WARN:
            # Numbers aside, a warning is logged once; the report lists all of them.
            gist = f"{node}: {NUMBER.sub('', message.msg)}"
            if gist not in self._logged:
                self._log(f"{node}: warning: {message.msg}")
            self._logged.add(gist)
        elif message.name in LOGGED_NODES:
            self._log(f"{node}: {message.msg}")
