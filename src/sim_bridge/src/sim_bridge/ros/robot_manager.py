"""Robots of a scene and their topics."""

from typing import Dict, FrozenSet, List, Mapping

import rospy
from tf2_msgs.msg import TFMessage

from planar import Pose2
from planar_ros.messages.conversion import LaserScanArrays
from sim_bridge.description import RobotProfile
from sim_bridge.robot import StepResult
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.motion_messages import TransformsMsg
from sim_bridge.ros.publishers import CountingPublisher
from sim_bridge.ros.robot_topics import RobotTopics
from sim_bridge.scene import Scene


class RobotManager:
    """Steps a scene with the commands received by its robots, and publishes what they measure.

    Args:
        scene: The simulated world.
        calls: Queue of the thread that owns the scene.
        joint_steps: Steps between two joint states of a robot whose description has no rate.
    """

    def __init__(self, scene: Scene, calls: CallQueue, joint_steps: int):
        self._scene = scene
        self._calls = calls
        self._joint_steps = joint_steps
        self._robots: Dict[str, RobotTopics] = {}
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=100, tcp_nodelay=True)

    def add(
        self, name: str, profile: RobotProfile, base_in_world: Pose2, z: float = 0.0, namespace: str = ""
    ) -> None:
        """Put a robot on the floor, and advertise its topics.

        Args:
            name: Name of the robot's model.
            profile: Parts, drive and sensors.
            base_in_world: Start pose of the base.
            z: Height at or below which the floor is searched [m].
            namespace: Namespace of its topics, if its description has none.

        Raises:
            WorldError: The robot cannot stand there, or the name is taken.
            RobotError: The description cannot be used.
        """
        overlapping = self._scene.add_robot(name, profile, base_in_world, z)
        if overlapping:
            rospy.logwarn("%s would start a little inside %s: moved out of it", name, ", ".join(overlapping))
        namespace = "/" + (profile.namespace or namespace.strip("/"))
        self._robots[name] = RobotTopics(
            self._scene, name, self._calls, self._joint_steps, namespace, _tf_prefix(namespace)
        )

    def remove(self, name: str) -> None:
        """Remove a model from the scene, and its topics if it is a robot.

        Raises:
            UnknownEntityError: There is no such model.
        """
        self._scene.remove_model(name)
        topics = self._robots.pop(name, None)
        if topics is not None:
            topics.close()

    def scan_topics(self) -> FrozenSet[str]:
        """Return the names of the topics with scans of a laser scanner."""
        scans = (each for each in self.publishers() if each.data_class is LaserScanArrays)
        return frozenset(each.resolved_name for each in scans)

    def publishers(self) -> List[CountingPublisher]:
        """Return the publishers of all topics of the robots."""
        return [publisher for topics in self._robots.values() for publisher in topics.publishers()]

    @property
    def odometry_seconds(self) -> float:
        """Longest time between two odometry messages of a robot [simulated s]."""
        return max((topics.odometry_seconds for topics in self._robots.values()), default=0.0)

    @property
    def commands_received(self) -> int:
        """Number of velocity commands that the robots have received."""
        return sum(topics.commands_received for topics in self._robots.values())

    def skip(self, count: int) -> None:
        """Advance the parked scene by ``count`` steps in which nothing is measured or published."""
        self._scene.skip(count)
        for topics in self._robots.values():
            topics.skip(count)

    def step(self) -> Mapping[str, StepResult]:
        """Step the scene by one odometry period; return the result of each robot, to be published."""
        commands = {name: topics.pop_command() for name, topics in self._robots.items()}
        results = self._scene.step({name: command for name, command in commands.items() if command})
        for topics in self._robots.values():
            topics.count_step()
        return results

    def publish_sensors(self, results: Mapping[str, StepResult]) -> None:
        """Publish the readings of a step except odometry."""
        for name, topics in self._robots.items():
            if name in results:
                topics.publish_sensors(results[name])

    def publish_motion(self, results: Mapping[str, StepResult]) -> None:
        """Publish odometry, ground truth and transforms of a step."""
        transforms = [
            transform
            for name, topics in self._robots.items()
            for transform in topics.publish_motion(results[name])
        ]
        if transforms:
            self._tf.publish(TransformsMsg(transforms))


def _tf_prefix(namespace: str) -> str:
    """Return tf_prefix of the nearest enclosing namespace that has it, else the namespace, as in Gazebo."""
    where = namespace.strip("/").split("/")
    for depth in range(len(where), -1, -1):
        name = "/".join(["", *where[:depth], "tf_prefix"])
        if rospy.has_param(name):
            return str(rospy.get_param(name)).strip("/")
    return namespace.strip("/")
