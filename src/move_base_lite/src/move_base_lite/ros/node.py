"""The node ``move_base``: a Navigator behind move_base's action, topics and services."""

import threading
from functools import partial
from typing import Callable, Dict, Optional

import rospy

from move_base_lite.config import NavigatorSettings
from move_base_lite.errors import NavigationError, RobotLost
from move_base_lite.navigator import Navigator
from move_base_lite.navigator.decision import Decision, Outcome, Status, Trigger, with_reason
from move_base_lite.navigator.zones import Zones, load_zones
from move_base_lite.parameters import settings_from_parameters
from move_base_lite.ros.goals.messages import InvalidGoal
from move_base_lite.ros.goals.plan_services import PlanServices
from move_base_lite.ros.goals.server import GoalServer
from move_base_lite.ros.sensing.surroundings import Surroundings, View
from move_base_lite.ros.topics.costmaps import CostmapTopics
from move_base_lite.ros.topics.decisions import DecisionTopics
from move_base_lite.ros.topics.potential import PotentialTopic
from move_base_lite.ros.topics.zones import ZoneTopics
from move_base_lite.ros.tuning import ParameterTree
from move_base_lite.warming import warm_up
from planar import OccupancyGrid, Pose2, SettingsError, Twist2
from planar_ros.messages.border import listen
from planar_ros.messages.conversion import OccupancyGridArrays, frame_name, grid_from_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.node.parameters import parameters_below
from planar_ros.node.shell import run
from planar_ros.node.waiting import Waiting
from planar_ros.step import Step, is_heard_in_step

WARN_SECONDS = 5.0
TIME_JUMP_TEXT = "Aborting on the goal because time has jumped back"


class MoveBaseNode:
    """Callbacks store; the Navigator is ticked in ROS time, and what it decides published.

    As with the official node, the action and the services come up when the map and the transforms are there.
    """

    def __init__(self):
        self._step = Step.of_node()
        parameters = parameters_below("~")
        self._settings = _checked_settings(parameters)
        zones_file = parameters.get("zones_file", "")
        self._zones = load_zones(zones_file) if zones_file else Zones()
        warm_up(self._settings)
        costmaps = self._settings.global_costmap, self._settings.local_costmap
        self._map_frame, odom_frame = (frame_name(costmap.global_frame) for costmap in costmaps)
        self._global_planner = _short_name(parameters, "base_global_planner", "navfn/NavfnROS")
        local_planner = _short_name(parameters, "base_local_planner", "")
        self._lock = threading.RLock()
        self._new_map: Optional[OccupancyGrid] = None
        self._navigator: Optional[Navigator] = None
        self._view: Optional[View] = None
        self._goal = Pose2()
        self._lost_since = rospy.Time(0)
        self._is_up = False
        self._topics = DecisionTopics(self._global_planner, local_planner, self._map_frame, odom_frame)
        self._potential = PotentialTopic(self._global_planner, self._map_frame)
        self._global_topics = CostmapTopics("global_costmap")
        self._local_topics = CostmapTopics("local_costmap")
        self._transforms = Transforms()
        rospy.on_shutdown(self._on_shutdown)  # before the goals end
        self._goals = GoalServer(self._map_frame, self._transforms, self._on_cancel)
        odom_topic = parameters.get("DWAPlannerROS", {}).get("odom_topic", "odom")
        self._surroundings = Surroundings(self._settings, self._transforms, odom_topic)
        self._tree = ParameterTree(parameters, self._change)
        self._await_inputs()
        self._step.every(self._period, self._tick, self._start_afresh, reports=True)
        self._step.join(self._has_map)

    def _await_inputs(self):
        local = self._settings.local_costmap
        frames = [self._map_frame, *map(frame_name, (local.global_frame, local.robot_base_frame))]
        transforms = f"the transforms {' -> '.join(frames)}"
        conditions: Dict[str, Callable[[], bool]] = {transforms: lambda: self._view is not None}
        for topic in self._surroundings.topics:
            conditions[f"a message on {topic}"] = partial(self._surroundings.has_heard, topic)
        static = self._settings.global_costmap.static
        if static.enabled:
            conditions[f"a map on {rospy.resolve_name(static.map_topic)}"] = (
                lambda: self._new_map is not None or self._navigator is not None
            )
            self._maps = listen(static.map_topic, OccupancyGridArrays, self._on_map, queue_size=1)
        else:
            self._navigator = Navigator(self._settings, None, self._zones)
        Waiting(conditions)

    def _on_map(self, message):
        self._new_map = grid_from_msg(message)

    def _change(self, settings: NavigatorSettings):
        with self._lock:
            self._settings = settings
            self._surroundings.change(settings)
            if self._navigator is not None:
                self._navigator.change(settings)

    def _has_map(self) -> bool:
        """Whether there is a map, or it is yet to be made."""
        is_there = self._new_map is not None or self._navigator is not None
        return is_there or is_heard_in_step(self._maps)

    def _period(self) -> float:
        return 1.0 / self._settings.move_base.controller_frequency

    def _start_afresh(self):
        rospy.logwarn("time has jumped back: forgetting goal, obstacles and transforms")
        with self._lock:
            self._surroundings.forget()
            for topics in (self._topics, self._global_topics, self._local_topics):
                topics.forget_time()
            if self._navigator is not None:
                self._navigator.forget()
            if self._goals.give_up(TIME_JUMP_TEXT):
                self._topics.command(Twist2())

    def _tick(self, now: rospy.Time):
        with self._lock:
            self._take_map()
            if self._navigator is None:
                return
            view = self._surroundings.view(now)
            if view is None:
                self._stand_still(self._navigator, now)
                return
            self._view, self._lost_since = view, now
            if not self._is_up:
                self._come_up(self._navigator)
            self._take_goal(self._navigator, now)
            decision = self._navigator.tick(
                now.to_sec(),
                view.base_in_map,
                view.base_in_odom,
                view.twist,
                None,
                view.sightings,
                self._step.latency,
            )
            self._act(now, view, decision)
            self._potential.publish(now, self._navigator.potential, self._settings.planner.publish_scale)
            self._global_topics.publish(now, self._navigator.global_costmap, view.base_in_map)
            self._local_topics.publish(now, self._navigator.local_costmap, view.base_in_odom)

    def _take_map(self):
        grid, self._new_map = self._new_map, None
        if grid is None:
            return
        if self._navigator is None:
            self._navigator = Navigator(self._settings, grid, self._zones)
        else:
            self._navigator.set_map(grid)

    def _come_up(self, navigator: Navigator):
        self._is_up = True
        PlanServices(
            navigator,
            self._lock,
            self._transforms,
            lambda: self._goals.is_active,
            self._where,
            self._global_planner,
        )
        ZoneTopics(self._zones, self._map_frame)
        self._goals.start()
        # Takes a while, for it talks to the parameter server a lot.
        threading.Thread(target=self._tree.serve, daemon=True).start()
        rospy.loginfo("odom received, map received: ready for goals")

    def _where(self) -> Optional[Pose2]:
        return self._view.base_in_map if self._view else None

    def _stand_still(self, navigator: Navigator, now: rospy.Time):
        """Without transforms nothing is safe but standing; goals still come, are cancelled and given up."""
        missing = f"waiting for {self._surroundings.missing_transform(now)}"
        rospy.logwarn_throttle(WARN_SECONDS, missing)
        self._take_goal(navigator, now)
        if not self._goals.is_active:
            self._lost_since = now
            return
        self._topics.command(Twist2())
        if (now - self._lost_since).to_sec() > self._settings.move_base.sensor_patience:
            lost = RobotLost(missing)
            self._refuse(navigator, with_reason(Trigger.CONTROLLING.value, lost), lost)

    def _take_goal(self, navigator: Navigator, now: rospy.Time):
        """Accepts a new goal, if one has come."""
        try:
            goal = self._goals.take(now)
        except InvalidGoal as error:
            self._refuse(navigator, str(error), error)
        except NavigationError as error:
            self._refuse(navigator, with_reason(Trigger.PLANNING.value, error), error)
        else:
            if goal is not None:
                self._goal = goal
                navigator.set_goal(goal)
                self._on_cancel()  # actionlib tells of none that came before it was taken

    def _on_cancel(self):
        """Does not wait for the next tick."""
        with self._lock:
            if self._navigator is not None and self._goals.is_cancelled:
                decision = self._navigator.cancel(rospy.get_time())
                self._topics.tell_end(decision)
                self._goals.end(decision.status, decision.text)

    def _refuse(self, navigator: Navigator, text: str, error: NavigationError):
        rospy.logerr(text)
        self._topics.outcome(Outcome(error.outcome, error.code, text))
        navigator.forget_goal()
        self._topics.command(Twist2())
        self._goals.end(Status.ABORTED, text)

    def _act(self, now: rospy.Time, view: View, decision: Decision):
        mode = self._settings.planner.orientation_mode
        self._topics.publish(now, decision, view.base_in_map, self._goal, mode)
        self._surroundings.note_command(decision.command or Twist2())
        self._goals.tell_pose(view.base_in_map, now)
        if decision.status.is_final:
            if decision.status is Status.ABORTED:
                rospy.logerr(decision.text)
            self._goals.end(decision.status, decision.text)
        elif decision.text:
            rospy.logwarn_throttle(WARN_SECONDS, decision.text)

    def _on_shutdown(self):
        """The action ends by itself."""
        with self._lock:
            self._navigator = self._new_map = None
            if self._is_up and self._goals.is_active:
                self._topics.stop_for_good()


def _checked_settings(parameters) -> NavigatorSettings:
    is_strict = parameters.get("strict_params", False)
    settings, warnings = settings_from_parameters(parameters, rospy.get_name() + "/", not is_strict)
    for warning in warnings:
        if warning.startswith("unknown parameter") and is_strict:
            raise SettingsError(warning)
        rospy.logwarn(warning)
    return settings


def _short_name(parameters, key: str, default: str) -> str:
    """The name of a plugin without its package."""
    return str(parameters.get(key, default)).rpartition("/")[2]


def main():
    run("move_base", MoveBaseNode)
