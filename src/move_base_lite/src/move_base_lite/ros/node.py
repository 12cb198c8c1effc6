"""Node move_base: the Navigator behind move_base's action, topics and services."""

import threading
from functools import partial
from typing import Callable, Dict, Optional

import rospy

from move_base_lite.config import NavigatorSettings
from move_base_lite.errors import NavigationError, RobotLost
from move_base_lite.navigator import Navigator
from move_base_lite.navigator.decision import Decision, GoalOutcome, RecoveryTrigger, Status, with_reason
from move_base_lite.navigator.zones import Zones, load_zones
from move_base_lite.parameters import settings_from_parameters
from move_base_lite.ros.goals.messages import InvalidGoal
from move_base_lite.ros.goals.plan_services import PlanServices
from move_base_lite.ros.goals.server import GoalServer
from move_base_lite.ros.reconfigure import ReconfigureServers
from move_base_lite.ros.sensing.sensor_bridge import NavigatorInputs, SensorBridge
from move_base_lite.ros.topics.costmaps import CostmapTopics
from move_base_lite.ros.topics.decisions import DecisionTopics
from move_base_lite.ros.topics.potential import PotentialTopic
from move_base_lite.ros.topics.zones import ZoneTopics
from move_base_lite.warmup import warm_up
from planar import OccupancyGrid, Pose2, SettingsError, Twist2
from planar_ros.lockstep import LockstepClient, has_synchronized_publisher
from planar_ros.messages.conversion import OccupancyGridArrays, frame_name, grid_from_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import subscribe
from planar_ros.node.parameters import parameters_below
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run

WARN_SECONDS = 5.0
TIME_JUMP_TEXT = "Aborting on the goal because time has jumped back"


class MoveBaseNode:
    """Stores inputs in callbacks, ticks the Navigator in ROS time and publishes its decisions.

    As with the official node, the action and the services start once map and transforms are available.
    """

    def __init__(self):
        self._step = LockstepClient.of_node()
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
        self._inputs: Optional[NavigatorInputs] = None
        self._goal = Pose2()
        self._lost_since = rospy.Time(0)
        self._is_up = False
        self._topics = DecisionTopics(self._global_planner, local_planner, self._map_frame, odom_frame)
        self._potential = PotentialTopic(self._global_planner, self._map_frame)
        self._global_topics = CostmapTopics("global_costmap")
        self._local_topics = CostmapTopics("local_costmap")
        self._transforms = Transforms()
        rospy.on_shutdown(self._on_shutdown)  # registered before the goal server, so that it runs first
        self._goals = GoalServer(self._map_frame, self._transforms, self._on_cancel)
        odom_topic = parameters.get("DWAPlannerROS", {}).get("odom_topic", "odom")
        self._sensors = SensorBridge(self._settings, self._transforms, odom_topic)
        self._tree = ReconfigureServers(parameters, self._change)
        self._await_inputs()
        self._step.every(self._period, self._tick, self._on_time_jump, reports=True)
        self._step.join(self._has_map)

    def _await_inputs(self):
        local = self._settings.local_costmap
        frames = [self._map_frame, *map(frame_name, (local.global_frame, local.robot_base_frame))]
        transforms = f"the transforms {' -> '.join(frames)}"
        conditions: Dict[str, Callable[[], bool]] = {transforms: lambda: self._inputs is not None}
        for topic in self._sensors.topics:
            conditions[f"a message on {topic}"] = partial(self._sensors.has_message, topic)
        static = self._settings.global_costmap.static
        if static.enabled:
            conditions[f"a map on {rospy.resolve_name(static.map_topic)}"] = (
                lambda: self._new_map is not None or self._navigator is not None
            )
            self._maps = subscribe(static.map_topic, OccupancyGridArrays, self._on_map, queue_size=1)
        else:
            self._navigator = Navigator(self._settings, None, self._zones)
        ReadinessMonitor(conditions)

    def _on_map(self, message):
        self._new_map = grid_from_msg(message)

    def _change(self, settings: NavigatorSettings):
        with self._lock:
            self._settings = settings
            self._sensors.update_settings(settings)
            if self._navigator is not None:
                self._navigator.update_settings(settings)

    def _has_map(self) -> bool:
        """Whether there is a map, or none is expected from a synchronised node."""
        is_there = self._new_map is not None or self._navigator is not None
        return is_there or has_synchronized_publisher(self._maps)

    def _period(self) -> float:
        return 1.0 / self._settings.move_base.controller_frequency

    def _on_time_jump(self):
        rospy.logwarn("time has jumped back: clearing goal, obstacles and transforms")
        with self._lock:
            self._sensors.reset()
            for topics in (self._topics, self._global_topics, self._local_topics):
                topics.reset_time()
            if self._navigator is not None:
                self._navigator.reset()
            if self._goals.abort(TIME_JUMP_TEXT):
                self._topics.publish_command(Twist2())

    def _tick(self, now: rospy.Time):
        with self._lock:
            self._apply_new_map()
            if self._navigator is None:
                return
            inputs = self._sensors.inputs(now)
            if inputs is None:
                self._wait_for_transforms(self._navigator, now)
                return
            self._inputs, self._lost_since = inputs, now
            if not self._is_up:
                self._start_services(self._navigator)
            self._accept_goal(self._navigator, now)
            decision = self._navigator.tick(
                now.to_sec(),
                inputs.base_in_map,
                inputs.base_in_odom,
                inputs.twist,
                None,
                inputs.observations,
                self._step.latency,
            )
            self._publish_decision(now, inputs, decision)
            self._potential.publish(now, self._navigator.potential, self._settings.planner.publish_scale)
            self._global_topics.publish(now, self._navigator.global_costmap, inputs.base_in_map)
            self._local_topics.publish(now, self._navigator.local_costmap, inputs.base_in_odom)

    def _apply_new_map(self):
        grid, self._new_map = self._new_map, None
        if grid is None:
            return
        if self._navigator is None:
            self._navigator = Navigator(self._settings, grid, self._zones)
        else:
            self._navigator.set_map(grid)

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
        return self._inputs.base_in_map if self._inputs else None

    def _wait_for_transforms(self, navigator: Navigator, now: rospy.Time):
        """Stop the robot; accept and cancel goals, and abort them after ~sensor_patience."""
        missing = f"waiting for {self._sensors.missing_transform(now)}"
        rospy.logwarn_throttle(WARN_SECONDS, missing)
        self._accept_goal(navigator, now)
        if not self._goals.is_active:
            self._lost_since = now
            return
        self._topics.publish_command(Twist2())
        if (now - self._lost_since).to_sec() > self._settings.move_base.sensor_patience:
            lost = RobotLost(missing)
            self._abort_goal(navigator, with_reason(RecoveryTrigger.CONTROLLING.value, lost), lost)

    def _accept_goal(self, navigator: Navigator, now: rospy.Time):
        """Accept a new goal, if there is one."""
        try:
            goal = self._goals.accept_goal(now)
        except InvalidGoal as error:
            self._abort_goal(navigator, str(error), error)
        except NavigationError as error:
            self._abort_goal(navigator, with_reason(RecoveryTrigger.PLANNING.value, error), error)
        else:
            if goal is not None:
                self._goal = goal
                navigator.set_goal(goal)
                self._on_cancel()  # actionlib reports no cancellation from before the goal was accepted

    def _on_cancel(self):
        """Cancel the goal at once, not at the next tick."""
        with self._lock:
            if self._navigator is not None and self._goals.is_cancelled:
                decision = self._navigator.cancel(rospy.get_time())
                self._topics.publish_end(decision)
                self._goals.finish(decision.status, decision.text)

    def _abort_goal(self, navigator: Navigator, text: str, error: NavigationError):
        rospy.logerr(text)
        self._topics.publish_outcome(GoalOutcome(error.outcome, error.code, text))
        navigator.clear_goal()
        self._topics.publish_command(Twist2())
        self._goals.finish(Status.ABORTED, text)

    def _publish_decision(self, now: rospy.Time, inputs: NavigatorInputs, decision: Decision):
        mode = self._settings.planner.orientation_mode
        self._topics.publish(now, decision, inputs.base_in_map, self._goal, mode)
        self._sensors.set_command(decision.command or Twist2())
        self._goals.publish_feedback(inputs.base_in_map, now)
        if decision.status.is_final:
            if decision.status is Status.ABORTED:
                rospy.logerr(decision.text)
            self._goals.finish(decision.status, decision.text)
        elif decision.text:
            rospy.logwarn_throttle(WARN_SECONDS, decision.text)

    def _on_shutdown(self):
        """Stop the robot; the action server aborts the goal."""
        with self._lock:
            self._navigator = self._new_map = None
            if self._is_up and self._goals.is_active:
                self._topics.publish_final_stop()


def _checked_settings(parameters) -> NavigatorSettings:
    is_strict = parameters.get("strict_params", False)
    settings, warnings = settings_from_parameters(parameters, rospy.get_name() + "/", not is_strict)
    for warning in warnings:
        if warning.startswith("unknown parameter") and is_strict:
            raise SettingsError(warning)
        rospy.logwarn(warning)
    return settings


def _short_name(parameters, key: str, default: str) -> str:
    """Name of a plugin without its package."""
    return str(parameters.get(key, default)).rpartition("/")[2]


def main():
    """Run the node ``move_base``."""
    run("move_base", MoveBaseNode)
