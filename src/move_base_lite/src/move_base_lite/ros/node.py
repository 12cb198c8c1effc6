"""Node move_base: the Navigator behind move_base's action, topics and services."""

import threading
from functools import partial
from typing import Any, Callable, Dict, Optional

import rospy

from move_base_lite.config import NavigatorSettings
from move_base_lite.errors import NavigationError
from move_base_lite.move_base import MoveBase, TickResult
from move_base_lite.navigator import Navigator
from move_base_lite.navigator.decision import Decision, RecoveryTrigger, Status, with_reason
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.navigator.zones import Zones, load_zones
from move_base_lite.parameters import read_parameters
from move_base_lite.parameters.costmaps import SEARCHED
from move_base_lite.ros.goals.messages import InvalidGoal
from move_base_lite.ros.goals.plan_services import PlanServices
from move_base_lite.ros.goals.server import GoalServer
from move_base_lite.ros.reconfigure import ReconfigureServers
from move_base_lite.ros.sensing.diagnostics import SensorDiagnostics
from move_base_lite.ros.sensing.sensor_bridge import SensorBridge
from move_base_lite.ros.sensing.static_maps import StaticMapTopics
from move_base_lite.ros.sensing.tf_poses import TfPoses
from move_base_lite.ros.topics.costmaps import CostmapTopics
from move_base_lite.ros.topics.decisions import DecisionTopics
from move_base_lite.ros.topics.potential import PotentialTopic
from move_base_lite.ros.topics.zones import ZoneTopics
from move_base_lite.warmup import warm_up
from planar import Pose2, Twist2
from planar.geometry.pose import pose_of_text
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms
from planar_ros.node.memory import load_numba_without_blas, release_compiler
from planar_ros.node.parameters import is_strict, parameters_below, report_without_effect
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run

WARN_SECONDS = 5.0
TIME_JUMP_TEXT = "Aborting on the goal because time has jumped back"


class MoveBaseNode:
    """Passes inputs to MoveBase in callbacks, ticks it in ROS time and publishes its decisions.

    As with the official node, the action and the services start once map and transforms are available.
    """

    def __init__(self):
        self._step = LockstepClient.of_node()
        parameters = {**_searched_parameters(), **parameters_below("~")}
        self._settings = _checked_settings(parameters)
        self._zones = _zones(parameters)
        load_numba_without_blas()
        warm_up(self._settings)
        release_compiler()
        costmaps = self._settings.global_costmap, self._settings.local_costmap
        self._map_frame, odom_frame = (frame_name(costmap.global_frame) for costmap in costmaps)
        self._global_planner = _short_name(parameters, "base_global_planner", "navfn/NavfnROS")
        local_planner = _short_name(parameters, "base_local_planner", "")
        self._lock = threading.RLock()
        self._state: Optional[RobotState] = None
        self._goal = Pose2()
        self._is_up = self._is_stopped = False
        self._topics = DecisionTopics(self._global_planner, local_planner, self._map_frame, odom_frame)
        self._potential = PotentialTopic(self._global_planner, self._map_frame)
        self._global_topics = CostmapTopics("global_costmap")
        self._local_topics = CostmapTopics("local_costmap")
        self._diagnostics = SensorDiagnostics()
        self._transforms = Transforms()
        base_frame = frame_name(self._settings.local_costmap.robot_base_frame)
        poses = TfPoses(self._transforms, self._map_frame, odom_frame, base_frame)
        self._move_base = MoveBase(self._settings, poses, None, self._zones, rospy.resolve_name)
        rospy.on_shutdown(self._on_shutdown)  # registered before the goal server, so that it runs first
        self._goals = GoalServer(self._map_frame, self._transforms, self._on_cancel)
        odom_topic = parameters.get("DWAPlannerROS", {}).get("odom_topic", "odom")
        self._sensors = SensorBridge(self._move_base, odom_topic)
        self._tree = ReconfigureServers(parameters, self._change)
        self._await_inputs()
        self._step.every(self._period, self._tick, self._on_time_jump, reports=True)
        self._step.join(self._maps.are_in_step)

    def _await_inputs(self):
        transforms = f"the transforms {' -> '.join(self._move_base.inputs.frames)}"
        conditions: Dict[str, Callable[[], bool]] = {transforms: lambda: self._state is not None}
        for topic in self._sensors.topics:
            conditions[f"a message on {topic}"] = partial(self._sensors.has_message, topic)
        sources, frames = self._move_base.map_sources, [*self._move_base.inputs.frames[:2]]
        self._maps = StaticMapTopics(sources, frames, self._transforms)
        for source in sources:
            conditions[f"a map on {rospy.resolve_name(source.topic)}"] = partial(self._maps.has_map, source)
        ReadinessMonitor(conditions)

    def _change(self, settings: NavigatorSettings):
        with self._lock:
            self._settings = settings
            self._move_base.update_settings(settings)

    def _period(self) -> float:
        return 1.0 / self._settings.move_base.controller_frequency

    def _on_time_jump(self):
        rospy.logwarn("time has jumped back: clearing goal, obstacles and transforms")
        with self._lock:
            self._move_base.reset()
            for topics in (self._topics, self._global_topics, self._local_topics):
                topics.reset_time()
            if self._goals.abort(TIME_JUMP_TEXT):
                self._topics.publish_command(Twist2())

    def _tick(self, now: rospy.Time):
        with self._lock:
            for source, static_map in self._maps.take_new().items():
                self._move_base.set_layer_map(source, static_map)
            if self._is_stopped or not self._move_base.is_ready:
                return
            self._accept_goal(now)
            if not self._move_base.is_due(now.to_sec()):
                return
            result = self._move_base.tick(now.to_sec(), self._step.latency)
            self._diagnostics.publish(result.fault, now)
            for complaint in result.complaints:
                rospy.logwarn(complaint)
            self._publish_decision(now, result)
            if result.state is not None:
                self._publish_state(now, result.state, self._move_base.navigator)

    def _publish_state(self, now: rospy.Time, state: RobotState, navigator: Navigator):
        self._state = state
        if not self._is_up:
            self._start_services(navigator)
        self._potential.publish(now, navigator.potential, self._settings.planner.publish_scale)
        self._global_topics.publish(now, navigator.global_costmap, state.base_in_map)
        self._local_topics.publish(now, navigator.local_costmap, state.base_in_odom)

    def _start_services(self, navigator: Navigator):
        self._is_up = True
        PlanServices(
            navigator,
            self._lock,
            self._transforms,
            lambda: self._goals.is_active,
            self._base_in_map,
            self._global_planner,
        )
        ZoneTopics(self._zones, self._map_frame)
        self._goals.start()
        # In a thread, since it makes many calls to the parameter server.
        threading.Thread(target=self._tree.serve, daemon=True).start()
        rospy.loginfo("odom received, map received: ready for goals")

    def _base_in_map(self) -> Optional[Pose2]:
        return self._state.base_in_map if self._state else None

    def _accept_goal(self, now: rospy.Time):
        """Accept a new goal, if there is one."""
        try:
            goal = self._goals.accept_goal(now)
        except InvalidGoal as error:
            self._finish(self._move_base.abort(str(error), error))
        except NavigationError as error:
            text = with_reason(RecoveryTrigger.PLANNING.value, error)
            self._finish(self._move_base.abort(text, error))
        else:
            if goal is not None:
                self._goal = goal
                self._move_base.set_goal(goal)
                self._on_cancel()  # actionlib reports no cancellation from before the goal was accepted

    def _on_cancel(self):
        """Cancel the goal at once, not at the next tick."""
        with self._lock:
            if self._move_base.is_ready and self._goals.is_cancelled:
                self._finish(self._move_base.cancel(rospy.get_time()))

    def _finish(self, decision: Decision):
        """Publish the end of a goal without a tick."""
        if decision.status is Status.ABORTED:
            rospy.logerr(decision.text)
        self._topics.publish_end(decision)
        self._goals.finish(decision.status, decision.text)

    def _publish_decision(self, now: rospy.Time, result: TickResult):
        decision, state = result.decision, result.state
        if state is None:
            self._topics.publish_end(decision)
        else:
            mode = self._settings.planner.orientation_mode
            self._topics.publish(now, decision, state.base_in_map, self._goal, mode)
            self._goals.publish_feedback(state.base_in_map, now)
        if decision.status.is_final:
            if decision.status is Status.ABORTED:
                rospy.logerr(decision.text)
            self._goals.finish(decision.status, decision.text)
        elif decision.text and self._is_up:  # before that, the ReadinessMonitor reports what is missing
            rospy.logwarn_throttle(WARN_SECONDS, decision.text)

    def _on_shutdown(self):
        """Stop the robot; the action server aborts the goal."""
        with self._lock:
            self._is_stopped = True
            if self._is_up and self._goals.is_active:
                self._topics.publish_final_stop()


def _checked_settings(parameters) -> NavigatorSettings:
    found = read_parameters(parameters, rospy.get_name() + "/", not is_strict())
    for warning in found.warnings:
        if warning not in found.unknown:
            rospy.logwarn(warning)
    report_without_effect([*found.without_effect], found.unknown, is_strict())
    return found.settings


def _zones(parameters: Dict[str, Any]) -> Zones:
    zones_file, dock = parameters.get("zones_file", ""), parameters.get("dock", "")
    zones = load_zones(zones_file) if zones_file else Zones()
    return zones.with_dock(pose_of_text(dock, rospy.resolve_name("~dock")) if dock else None)


def _searched_parameters() -> Dict[str, Any]:
    """Parameters of the robot that stand above the node's namespace, as costmap_2d searches them."""
    found = {name: rospy.search_param(name) for name in SEARCHED}
    return {name: rospy.get_param(place) for name, place in found.items() if place is not None}


def _short_name(parameters, key: str, default: str) -> str:
    """Name of a plugin without its package."""
    return str(parameters.get(key, default)).rpartition("/")[2]


def main():
    """Run the node ``move_base``."""
    run("move_base", MoveBaseNode)
