"""The node ``service``: requests by HTTP and ROS, carried out by navigation and docking."""

import hashlib
import math
import sys
import time
from functools import partial
from pathlib import Path
from typing import Callable, Dict, List, Optional, Tuple

import rospy

from pick_objects import Mission, load_mission, search_area_of
from planar import OccupancyGrid, Pose2
from planar.geometry.pose import pose_of_text
from planar.maps.places import load_places, obstruction_at, unreachable_reason
from planar.maps.semantic_map import load_semantic_map
from planar_ros.lockstep import LockstepClient
from planar_ros.lockstep.ticker import IDLE_TOPIC, ProgressPublisher
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg
from planar_ros.messages.validation import subscribe
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import NodeReadiness, ReadinessMonitor
from planar_ros.node.runner import fail, run
from service.config import EnergySettings, NodeSettings, ServiceSettings
from service.host import ServiceHost
from service.http.server import HttpServer
from service.idle import idle_until
from service.journal import Journal
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.mission_requests import documents_of
from service.requests.parser import Knowledge
from service.requests.timed_requests import RequestFeed, load_requests
from service.ros.deliver_action import RosRequests
from service.ros.mission_topics import MissionTopics
from service.ros.robot_client import RobotClient
from service.task_book import JournalEntry

POLL_SECONDS = 0.02
# Longest time for which the service states to have nothing to do [s].
LONGEST_IDLE = 3600.0
JOURNAL_FILE = "journal.db"
# Unix time at ROS time 0, while time is simulated; it survives the node, not the master.
ORIGIN = "~origin"
KINDS = (NodeSettings, ServiceSettings, EnergySettings)


class ServiceNode:
    """Restores the service from its journal and runs it."""

    def __init__(self) -> None:
        self._step, self._idle = LockstepClient.of_node(), ProgressPublisher(IDLE_TOPIC)
        self._settings, self._service_settings, self._energy = _settings()
        path = self._settings.semantic_map_file
        self._semantic_map = load_semantic_map(path) if path else None
        self._mission, self._documents = self._read_mission()
        file = self._settings.requests_file
        self._timed_requests = load_requests(Path(file)) if file else []
        self._map: Optional[OccupancyGrid] = None
        subscribe("map", OccupancyGridArrays, self._keep_map, queue_size=1)
        self._required: Dict[str, Callable[[], bool]] = {
            f"a map on {rospy.resolve_name('map')}": lambda: self._map is not None
        }
        for name in map(rospy.resolve_name, self._settings.wait_for.split()):
            self._required[f"{name} to be ready"] = NodeReadiness(name)
        ReadinessMonitor(self._required)
        self._wait_for_all()
        folder = Path(self._settings.state_folder)
        self._host = ServiceHost(folder / JOURNAL_FILE, self._make, rospy.logwarn)
        assert self._host.journal is not None
        snapshot = self._host.journal.restore()
        self._robot = RobotClient(
            self._settings.frame_id, snapshot.robot.pose if snapshot.robot else Pose2(), bool(path)
        )
        self._origin = _origin(snapshot.latest)
        self._topics = MissionTopics(self._settings.frame_id, self._mission)
        self._requests = RosRequests(self._host, self._mission, self._topics)
        self._http = HttpServer(self._host, folder, self._settings.http_address, self._settings.http_port)

    def work(self) -> None:
        """Run until shutdown."""
        self._topics.publish(self._service, self._origin)
        self._step.join(takes_turns=True)
        move_base = self._robot.navigation.move_base
        self._wait_for({move_base.name: move_base.is_ready})
        self._submit_mission()
        self._host.listen(0, _warn)
        self._http.start()
        rospy.loginfo("requests at %s; %d are open", self._http.url, len(self._service.book.tasks))
        while not rospy.is_shutdown():
            stamp = rospy.get_time()
            now = self._origin + stamp
            self._requests.update(now)
            if self._host.service is not None:
                self._feed.advance(now)
            order = self._host.cycle(now, self._robot.inputs(), self._robot.event(stamp))
            if self._host.service is not None:
                self._topics.publish(self._host.service, now)
            self._robot.carry_out(order, stamp)
            self._state_idle_time(stamp)
            self._step.pause(POLL_SECONDS)
        self._http.stop()
        self._host.close()
        self._topics.flush()

    def _state_idle_time(self, stamp: float) -> None:
        """Publish until when nothing is due; ``stamp`` is ROS time [s]."""
        service, now = self._host.service, self._origin + stamp
        if service is None:
            return
        due = service.wakes_at(now), self._feed.next_stamp, now + LONGEST_IDLE
        until = idle_until(now, self._robot.is_moving, *due)
        if until > now:
            self._idle.report(rospy.Time.from_sec(until - self._origin))

    @property
    def _service(self) -> RequestService:
        assert self._host.service is not None
        return self._host.service

    @property
    def _staging(self) -> Optional[Pose2]:
        """Pose before the dock, facing it; None without a dock."""
        if not self._settings.dock:
            return None
        dock = pose_of_text(self._settings.dock, "~dock")
        return dock @ Pose2(self._settings.staging_distance, 0.0, math.pi)

    def _make(self, journal: Journal) -> RequestService:
        assert self._map is not None
        travel, staging = GridTravelTimes(self._map, self._settings.speed), self._staging
        around = PlanningModel(travel, self._energy, staging)
        semantic_map = self._semantic_map
        known = Knowledge(tuple(self._mission.places), staging is not None, semantic_map=semantic_map)
        area = search_area_of(self._map, semantic_map)
        site = Site(self._mission.places, around, known, area)
        service = RequestService(
            site, self._service_settings, journal.restore(), find_ended=journal.ended_task
        )
        # By their ids a service that goes on knows those that it has accepted.
        on_refused = partial(rospy.logwarn, "request refused: %s")
        self._feed = RequestFeed(self._timed_requests, service.submit, on_refused)
        return service

    def _read_mission(self) -> Tuple[Mission, List[Dict[str, object]]]:
        zones = load_places(self._settings.zones_file)
        path = self._settings.mission_file
        if not path:
            return Mission("service", zones, ()), []
        mission = load_mission(path, zones, semantic_map=self._semantic_map)
        digest = hashlib.sha256(Path(path).read_bytes()).hexdigest()[:12]
        return mission, documents_of(mission, f"mission-{digest}")

    def _submit_mission(self) -> None:
        """Accept the mission's deliveries once: a service that goes on knows them by their ids."""
        for document in self._documents:
            self._service.submit(document, self._origin + rospy.get_time())

    def _wait_for_all(self) -> None:
        self._wait_for(self._required)
        assert self._map is not None
        for place in self._mission.places.values():
            problem = unreachable_reason(place, self._map)
            if problem:
                fail(problem)
        staging = self._staging
        problem = None if staging is None else obstruction_at(staging, self._map)
        if staging is not None and problem:
            before = (
                f"({staging.x:.2f}, {staging.y:.2f}), {self._settings.staging_distance:g} m before the dock,"
            )
            fail(f"{before} {problem}; the pose of the dock is that of its front, facing the robot")

    def _wait_for(self, required: Dict[str, Callable[[], bool]]) -> None:
        """Wait for what is required; end the node if it does not come."""
        seconds = self._settings.server_timeout
        deadline = time.monotonic() + seconds
        while not all(is_met() for is_met in required.values()) and not rospy.is_shutdown():
            if time.monotonic() > deadline:
                missing = [what for what, is_met in required.items() if not is_met()]
                fail(f"not ready after {seconds:g} s: waiting for {', '.join(missing)}", exit_code=1)
            self._step.pause(POLL_SECONDS)

    def _keep_map(self, message: OccupancyGridArrays) -> None:
        self._map = grid_from_msg(message)


def _warn(_number: int, entry: JournalEntry) -> None:
    """Log an entry of the service's log that people should act on."""
    if entry.kind == "battery":
        rospy.logwarn("%s", entry.text)


def _settings() -> Tuple[NodeSettings, ServiceSettings, EnergySettings]:
    names = {ORIGIN.lstrip("~"), *(name for kind in KINDS for name in kind.__dataclass_fields__)}
    return (
        read_settings(NodeSettings, ignore=names),
        read_settings(ServiceSettings, ignore=names),
        read_settings(EnergySettings, ignore=names),
    )


def _origin(latest: float) -> float:
    """Return the Unix time at ROS time 0 [s].

    Simulated time starts at 0 with each simulation; the service's time goes on from the journal, or from the
    wall clock if that is later.

    Args:
        latest: Latest Unix time in the journal [s].
    """
    if not rospy.get_param("/use_sim_time", False):
        return 0.0
    origin = rospy.get_param(ORIGIN, None)
    if not isinstance(origin, float):
        origin = math.ceil(max(latest, time.time())) - rospy.get_time()
        rospy.set_param(ORIGIN, origin)
    return origin


def main() -> None:
    """Run the node."""

    def start() -> ServiceNode:
        node = ServiceNode()
        node.work()
        return node

    run("service", start)
    sys.exit(0)
