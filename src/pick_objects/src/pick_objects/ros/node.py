"""ROS node of pick_objects: carries out missions with move_base."""

import sys
import threading
import time
from typing import Callable, Dict, List, Optional

import rospy
from home_service_msgs.msg import DeliverGoal
from home_service_msgs.srv import AddDelivery, AddDeliveryResponse, CancelDelivery, CancelDeliveryResponse
from std_srvs.srv import Empty

from pick_objects.checkpoint import checkpoint_of, resume_errand
from pick_objects.config import ErrandSettings, NodeSettings
from pick_objects.errand import Errand, Event
from pick_objects.mission import Mission, MissionError, errand_mission
from pick_objects.mission_file import load_mission, parse_mission
from pick_objects.ros.deliver_server import DeliverServer
from pick_objects.ros.mission_publisher import MissionPublisher, delivery_from_msg
from pick_objects.ros.navigation_client import NavigationClient
from pick_objects.search.area import SearchArea, search_area_of
from planar import OccupancyGrid
from planar.driving import FinishTask
from planar.maps.places import NamedPlace, load_pickup_and_dropoff, load_places, unreachable_reason
from planar.maps.semantic_map import load_semantic_map
from planar_ros.calls.services import ServiceError, call_service
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg
from planar_ros.messages.validation import subscribe
from planar_ros.node.checkpoint import ParameterCheckpoint
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import NodeReadiness, ReadinessMonitor
from planar_ros.node.runner import fail, run

POLL_SECONDS = 0.02
# How long before the time of not_before the costmaps are cleared [simulated s], and the service for it.
CLEARED_SECONDS, CLEAR_COSTMAPS = 1.0, "move_base/clear_costmaps"


class PickObjectsNode:
    """Carries out the mission of a file, the errand between two zones, or goals of the action ``deliver``."""

    def __init__(self):
        self._step = LockstepClient.of_node()
        self._settings = read_settings(NodeSettings, ignore=ErrandSettings.__dataclass_fields__)
        self._defaults = read_settings(ErrandSettings, ignore=NodeSettings.__dataclass_fields__)
        self._map: Optional[OccupancyGrid] = None
        self._zones = load_places(self._settings.zones_file)
        path = self._settings.semantic_map_file
        self._semantic_map = load_semantic_map(path) if path else None
        self._area: Optional[SearchArea] = None
        self._mission = self._read_mission()
        rospy.set_param("~places", list(self._places))  # for user interfaces, in the order of the file
        self._errand: Optional[Errand] = None
        self._checkpoint = ParameterCheckpoint() if self._settings.resume else None
        self._lock = threading.Lock()
        self._navigation = NavigationClient(self._settings.frame_id, detects=bool(path))
        self._topics = MissionPublisher(self._settings.frame_id, lambda: self._navigation.driver.base_in_map)
        subscribe("map", OccupancyGridArrays, self._keep_map, queue_size=1)
        rospy.Service("~add_delivery", AddDelivery, self._on_add)
        rospy.Service("~cancel_delivery", CancelDelivery, self._on_cancel)
        self._required = {self._navigation.move_base.name: self._navigation.move_base.is_ready}
        for name in map(rospy.resolve_name, self._settings.wait_for.split()):
            self._required[f"{name} to be ready"] = NodeReadiness(name)
        ReadinessMonitor(
            {f"a map on {rospy.resolve_name('map')}": lambda: self._map is not None, **self._required}
        )

    def work(self) -> FinishTask:
        """Carry out the mission and return its end; with ``~serve`` continue until shutdown."""
        outcome = FinishTask(True, "served")
        if self._mission is not None:
            self._topics.publish(self._resume(self._mission))
        obstacle = self._wait_until_ready()
        if obstacle:
            return FinishTask(False, obstacle)
        if self._mission is not None:
            mission = self._reload_mission(self._mission)
            outcome = self._carry_out(mission, self._resume(mission), self._checkpoint)
        if self._settings.serve:
            DeliverServer(self._topics, self._parse_goal, self._carry_out_goal).serve(
                lambda: self._step.pause(POLL_SECONDS)
            )
        return outcome

    def finish(self) -> None:
        """Publish the final state to all subscribers; with ``~resume`` keep running until shutdown."""
        self._topics.flush()
        while self._settings.resume and not rospy.is_shutdown():
            self._step.pause(POLL_SECONDS)

    def _read_mission(self) -> Optional[Mission]:
        settings = self._settings
        if settings.mission_file:
            mission = load_mission(
                settings.mission_file, self._zones, self._defaults, self._map, self._semantic_map
            )
            mission.check_searches(self._semantic_map)
            return mission
        if settings.serve:
            return None
        return errand_mission(*load_pickup_and_dropoff(settings.zones_file), self._defaults)

    @property
    def _places(self) -> Dict[str, NamedPlace]:
        return {**self._zones, **(self._mission.places if self._mission else {})}

    def _reload_mission(self, mission: Mission) -> Mission:
        """Read the mission again, now that there is a map to check it against."""
        self._mission = self._read_mission() or mission
        return self._mission

    def _carry_out_goal(self, mission: Mission, watch: Callable[[Errand], None]) -> FinishTask:
        """Carry out the mission of a goal, which has no checkpoint: it ends with its node."""
        return self._carry_out(mission, Errand(mission, self._area), watch=watch)

    def _carry_out(
        self,
        mission: Mission,
        errand: Errand,
        checkpoint: Optional[ParameterCheckpoint] = None,
        watch: Callable[[Errand], None] = lambda errand: None,
    ) -> FinishTask:
        obstacle = self._unreachable_place(mission)
        if obstacle:
            return FinishTask(False, obstacle)
        self._errand = errand
        event: Optional[Event] = None
        driver = self._navigation.driver
        while not rospy.is_shutdown():
            with self._lock:
                self._errand.base_in_map = driver.base_in_map
                order = self._errand.advance(rospy.get_time(), event)
                self._topics.publish(self._errand)
                if checkpoint is not None:
                    checkpoint.save(checkpoint_of(self._errand))
                if isinstance(order, FinishTask):
                    self._navigation.move_base.cancel_all()
                    return order
                watch(self._errand)
            event = driver.carry_out(order)
            if event is None:
                self._step.pause(POLL_SECONDS)
                event = driver.event(rospy.get_time())
        return FinishTask(False, "interrupted")

    def _resume(self, mission: Mission) -> Errand:
        """Return the errand of the node's mission as a crashed process left it, or a new one.

        The checkpoint stays after the mission's end, until the node's: a respawned node does not repeat it.
        """
        if self._checkpoint is None:
            return Errand(mission, self._area)
        resumed = self._checkpoint.recovered(lambda record: resume_errand(mission, record, self._area))
        return resumed or Errand(mission, self._area)

    def _wait_until_ready(self) -> Optional[str]:
        settings = self._settings
        if not self._wait_for(lambda: self._map is not None, settings.map_timeout):
            rospy.logwarn("no map within %g s: the places are not checked", settings.map_timeout)
        elif self._map is not None:
            self._area = search_area_of(self._map, self._semantic_map)
        self._step.join(takes_turns=True)
        if not self._wait_for(lambda: not self._missing(), settings.server_timeout):
            return f"not ready after {settings.server_timeout:g} s: waiting for {', '.join(self._missing())}"
        if settings.not_before > 0.0:
            self._pause_until(settings.not_before - CLEARED_SECONDS)
            self._clear_costmaps()
            self._pause_until(settings.not_before)
        return None

    def _pause_until(self, stamp: float) -> None:
        while rospy.get_time() < stamp and not rospy.is_shutdown():
            self._step.pause(POLL_SECONDS)

    def _clear_costmaps(self) -> None:
        """Clear obstacles of scans that move_base received or not, depending on when it was ready."""
        try:
            call_service(CLEAR_COSTMAPS, Empty, Empty._request_class(), self._settings.server_timeout)
        except ServiceError as error:
            rospy.logwarn("the costmaps are not cleared before the mission: %s", error)

    def _missing(self) -> List[str]:
        return [what for what, is_met in self._required.items() if not is_met()]

    def _unreachable_place(self, mission: Mission) -> Optional[str]:
        names = dict.fromkeys(name for d in mission.deliveries for name in (d.source, d.destination) if name)
        problems: List[Optional[str]] = [
            unreachable_reason(mission.places[name], self._map) for name in names if self._map is not None
        ]
        return next((problem for problem in problems if problem), None)

    def _parse_goal(self, goal: DeliverGoal) -> Mission:
        mission = self._mission_of_goal(goal)
        mission.check_searches(self._semantic_map)
        return mission

    def _mission_of_goal(self, goal: DeliverGoal) -> Mission:
        places = self._places
        if goal.mission:
            if goal.deliveries:
                raise MissionError("a goal holds either a mission or deliveries, not both")
            return parse_mission(goal.mission, places, self._defaults, self._map, self._semantic_map)
        if not goal.deliveries:
            raise MissionError("the goal holds neither a mission nor deliveries")
        settings = ErrandSettings(
            **{
                **vars(self._defaults),
                "order": "shortest" if goal.shortest_order else "given",
                "on_failure": "continue" if goal.continue_on_failure else "stop",
            }
        )
        objects = self._mission.objects if self._mission else {}
        mission = Mission("deliveries", places, (), objects, settings)
        for message in goal.deliveries:
            mission = mission.with_delivery(delivery_from_msg(message))
        return mission

    def _on_add(self, request):
        return self._change(
            AddDeliveryResponse, lambda errand: errand.add(delivery_from_msg(request.delivery))
        )

    def _on_cancel(self, request):
        return self._change(CancelDeliveryResponse, lambda errand: errand.cancel(request.name))

    def _change(self, response_kind, change: Callable[[Errand], object]):
        try:
            with self._lock:
                if self._errand is None:
                    raise MissionError("no mission is running")
                change(self._errand)
        except MissionError as error:
            return response_kind(False, str(error))
        return response_kind(True, "")

    def _wait_for(self, is_there: Callable[[], bool], seconds: float) -> bool:
        """Wait at most so many wall-clock seconds; return whether the condition is met."""
        deadline = time.monotonic() + seconds
        while not is_there() and time.monotonic() < deadline and not rospy.is_shutdown():
            self._step.pause(POLL_SECONDS)
        return is_there()

    def _keep_map(self, message):
        self._map = grid_from_msg(message)


def main():
    def start():
        node = PickObjectsNode()
        outcome = node.work()
        if rospy.is_shutdown():
            return
        if outcome.success:
            rospy.loginfo("%s", outcome.reason)
        node.finish()
        if not outcome.success:
            fail(outcome.reason, exit_code=1)
        rospy.signal_shutdown("mission done")

    run("pick_objects", start)
    sys.exit(0)
