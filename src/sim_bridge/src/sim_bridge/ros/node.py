"""The node ``sim_bridge``: a Scene with Gazebo's topics and services, and simulated time."""

import dataclasses
import threading
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Tuple

import rospy
from rospkg import RosPack
from visualization_msgs.msg import Marker

from planar import PlanarError, Pose2, Scan
from planar.config.settings import check
from planar.geometry.pose import pose_of_text
from planar.maps.semantic_map import load_objects
from planar_ros.lockstep import transport
from planar_ros.lockstep.transport import LockstepConnection
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.node.parameters import parameters_below, read_settings, report_without_effect
from planar_ros.node.runner import run
from rospy_transport.replacements import install
from sim_bridge.config import BridgeSettings, RobotSettings, SimulationSettings
from sim_bridge.description import RobotProfile, read_sdf_robot
from sim_bridge.docks import with_dock
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.noise import noise_named
from sim_bridge.pacing import Pacer
from sim_bridge.rest.rules import parse_rules, read_known_nodes
from sim_bridge.rest.threads import wake_promptly
from sim_bridge.robots import robot_named
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.description import find_file, model_folders
from sim_bridge.ros.faults.service import FaultServer
from sim_bridge.ros.gazebo import GazeboInterface
from sim_bridge.ros.gazebo.server import NAMESPACE
from sim_bridge.ros.performance import Performance
from sim_bridge.ros.robot_manager import RobotManager
from sim_bridge.ros.timing.idle_time import IdleTime
from sim_bridge.ros.timing.lock_step import LockStep
from sim_bridge.ros.timing.node_search import NodeSearch
from sim_bridge.ros.timing.paced_nodes import PacedNodes
from sim_bridge.ros.timing.stamped_messages import StampedMessages
from sim_bridge.ros.timing.time_control import TimeControl
from sim_bridge.scene import Scene
from sim_bridge.sdf import load_world
from sim_bridge.sensors.object_detector import with_object_detector
from sim_bridge.simulation import ROBOT_NAME, StepResult, box_on_floor
from sim_bridge.views.section import warm_up
from sim_bridge.world import World


def world_of_file(settings: BridgeSettings) -> World:
    """Load the world of the parameter ~world.

    Raises:
        WorldError: The file cannot be used.
    """
    return load_world(settings.world, model_folders(), settings.strict)


class Bridge:
    """Steps a scene in one thread; callbacks in other threads submit calls to it.

    Args:
        world_of: Makes the world from the node's settings.
    """

    def __init__(self, world_of: Callable[[BridgeSettings], World] = world_of_file):
        threading.Thread(target=warm_up, daemon=True).start()  # in parallel with calls to the master
        settings, robot = (_read(kind) for kind in (BridgeSettings, RobotSettings))
        simulation_settings = _read(SimulationSettings, noise_named(settings.noise))
        rate = simulation_settings.odometry_rate
        clock_steps = _steps_between(settings.clock_rate, rate, "clock_rate")
        joint_steps = _steps_between(settings.joint_state_rate, rate, "joint_state_rate")
        world = world_of(settings)
        if settings.dock:
            world = with_dock(world, pose_of_text(settings.dock, "~dock"))
        robots = _robots_of(world, robot, settings.objects_file)
        profiles = (profile for _, profile, *_ in robots)
        warnings = [*world.warnings, *chain(*(each.warnings for each in profiles))]
        report_without_effect([], warnings, settings.strict, WorldError, "strict")
        self._calls = CallQueue()
        self._faults = FaultServer(settings.faults_file, settings.seed, self._calls)
        self._scene = Scene(world, simulation_settings, settings.seed, self._faults.wrappers)
        wait_for, static_publishers = map(_names, (settings.wait_for, settings.static_publishers))
        pacer = Pacer(settings.speed, wait_for)
        self._lock_step = LockStep(wait_for, static_publishers, settings.latency, self._calls)
        self._performance = Performance()
        paced = self._paced_nodes(settings, pacer)
        self._robots = RobotManager(self._scene, self._calls, joint_steps)
        idle = IdleTime(
            self._scene, self._robots, self._faults, self._lock_step, self._calls, settings.skip_idle
        )
        self._time = TimeControl(self._scene, pacer, self._lock_step, paced, idle, self._calls, clock_steps)
        for start in robots:
            self._robots.add(*start)
        # As Gazebo does: nodes that start from now on use simulated time.
        if not rospy.has_param("/use_sim_time"):
            rospy.set_param("/use_sim_time", True)
        self._gazebo = GazeboInterface(
            self._scene, self._robots, self._time, self._calls, model_folders(), settings.strict
        )
        if rospy.resolve_name("~") != NAMESPACE:  # else Gazebo's own parameters have that name
            self._time.advertise_speed()
        rospy.Subscriber("~add_box", Marker, self._on_box, queue_size=10)

    def run(self) -> None:
        """Step until shutdown."""
        transport.batch_sends()
        wake_promptly()
        try:
            while not rospy.is_shutdown():
                self._calls.run_pending(self._lock_step.awaited, self._lock_step.members)
                self._time.set_odometry_period(self._robots.odometry_seconds)
                if not self._time.wait_for_step():
                    continue
                self._step()
                self._performance.report(self._scene.stamp, self._robots.publishers)
        finally:
            transport.flush()
            self._time.close()
            self._calls.close()
            self._scene.close()

    def _paced_nodes(self, settings: BridgeSettings, pacer: Pacer) -> PacedNodes:
        file = settings.known_file or Path(RosPack().get_path("sim_bridge"), "config", "known_nodes.yaml")
        rules, known = parse_rules(settings.pace), read_known_nodes(Path(file))
        bystanders = tuple(f"/{name}" for name in settings.bystanders.split())
        messages = StampedMessages(
            pacer.follow,
            lambda name, stamp: self._calls.submit(lambda: pacer.report(name, stamp), acts=False),
        )
        search = NodeSearch(rules, known, bystanders)
        remark = self._lock_step.add_remark
        return PacedNodes(self._calls, remark, rules, search, messages, settings.pace_all)

    def _step(self):
        results = self._robots.step()
        if any(map(_has_scan, results.values())) and self._time.may_defer(self._robots.scan_topics()):
            self._robots.publish_motion(results)
            self._time.defer(partial(self._robots.publish_sensors, results))
        else:
            self._robots.publish_sensors(results)
            self._robots.publish_motion(results)
        self._faults.update(self._scene, results)
        self._gazebo.publish()
        self._time.on_step_finished()

    def _on_box(self, message):
        self._calls.submit(lambda: self._add_box(message))

    def _add_box(self, message):
        size = (message.scale.x, message.scale.y, message.scale.z)
        name = message.ns or f"box_{message.id}"
        try:
            self._scene.add([box_on_floor(name, size, pose2_from_msg(message.pose))])
            rospy.loginfo("%s added", name)
        except PlanarError as error:
            rospy.logwarn("box not added: %s", error)


def _has_scan(result: StepResult) -> bool:
    return any(isinstance(reading.value, Scan) for reading in result.readings.values())


def _read(kind: type, defaults: Mapping[str, Any] = {}) -> Any:
    """Read one of the settings classes that share the node's private parameters."""
    kinds = (BridgeSettings, SimulationSettings, RobotSettings)
    known = {field.name for each in kinds for field in dataclasses.fields(each)}
    return read_settings(kind, ignore=known, defaults=defaults)


def _robots_from_parameters(robot: RobotSettings) -> Dict[str, RobotSettings]:
    """Return robots by name: those below ~robots if there are any, else the one of ``robot``."""
    names = parameters_below("~robots")
    if names:
        return {name: read_settings(RobotSettings, namespace=f"~robots/{name}") for name in sorted(names)}
    return {ROBOT_NAME: robot} if robot.robot else {}


def _robots_of(
    world: World, robot: RobotSettings, objects_file: str
) -> List[Tuple[str, RobotProfile, Pose2, float, str]]:
    """Return name, profile, start, height and namespace of the robots of the parameters and of a world.

    With a file of objects, those of the parameters have a detector.
    """
    objects = load_objects(objects_file) if objects_file else ()
    robots = []
    for name, each in _robots_from_parameters(robot).items():
        start = Pose2(each.x, each.y, each.yaw)
        profile = with_object_detector(robot_named(each.robot, find_file), objects)
        robots.append((name, profile, start, 0.0, each.namespace))
    for model in world.robots:
        profile, pose = read_sdf_robot(model)
        robots.append((model.name, profile, to_pose2(pose), float(pose[2, 3]), ""))
    return robots


def _steps_between(rate: int, step_rate: int, name: str) -> int:
    check(step_rate % rate == 0, f"~{name}", f"a divisor of odometry_rate ({step_rate})", rate)
    return step_rate // rate


def _names(text: str) -> List[str]:
    """Return names of nodes without slash."""
    return [name.lstrip("/") for name in text.split()]


def main():
    install(LockstepConnection)
    run("sim_bridge", lambda: Bridge().run())
