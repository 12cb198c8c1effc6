"""The robots of a scene and their topics."""

from typing import Dict, List, Mapping

import rospy
from tf2_msgs.msg import TFMessage

from planar import Pose2
from sim_bridge.description import RobotProfile
from sim_bridge.robot import StepResult
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.motion_messages import TransformsMsg
from sim_bridge.ros.publishers import CountingPublisher
from sim_bridge.ros.robot_topics import RobotTopics
from sim_bridge.scene import Scene


class RobotManager:
    """Steps a scene: hands its robots the commands that have come, tells what they observe."""

    def __init__(self, scene: Scene, calls: CallQueue, joint_steps: int):
        self._scene = scene
        self._calls = calls
        self._joint_steps = joint_steps
        self._robots: Dict[str, RobotTopics] = {}
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=100, tcp_nodelay=True)

    def add(
        self, name: str, profile: RobotProfile, base_in_world: Pose2, z: float = 0.0, namespace: str = ""
    ) -> None:
        """Puts a robot on the floor at, or below, the height ``z``.

        Its topics are where its description says, else below ``namespace``. Raises WorldError, RobotError.
        """
        for warning in profile.warnings:
            rospy.logwarn("%s", warning)
        met = self._scene.add_robot(name, profile, base_in_world, z)
        if met:
            rospy.logwarn("%s would start a little inside %s: moved out of it", name, ", ".join(met))
        namespace = "/" + (profile.namespace or namespace.strip("/"))
        self._robots[name] = RobotTopics(
            self._scene, name, self._calls, self._joint_steps, namespace, _tf_prefix(namespace)
        )

    def remove(self, name: str) -> None:
        """Takes a model out of the scene, and its topics if it is a robot. Raises UnknownEntityError."""
        self._scene.remove_model(name)
        topics = self._robots.pop(name, None)
        if topics is not None:
            topics.close()

    def publishers(self) -> List[CountingPublisher]:
        """Of all topics of the robots."""
        return [publisher for topics in self._robots.values() for publisher in topics.publishers()]

    @property
    def odometry_seconds(self) -> float:
        """Of all robots, the most simulated seconds between two messages of odometry."""
        return max((topics.odometry_seconds for topics in self._robots.values()), default=0.0)

    def step(self) -> Mapping[str, StepResult]:
        """Moves on by one period of the odometry; what each robot observes."""
        commands = {name: topics.take_command() for name, topics in self._robots.items()}
        seen = self._scene.step({name: command for name, command in commands.items() if command})
        transforms = [
            transform for name, topics in self._robots.items() for transform in topics.publish(seen[name])
        ]
        if transforms:
            self._tf.publish(TransformsMsg(transforms))
        return seen


def _tf_prefix(namespace: str) -> str:
    """The parameter tf_prefix of a namespace or of the nearest around it, else itself, as in Gazebo."""
    where = namespace.strip("/").split("/")
    for depth in range(len(where), -1, -1):
        name = "/".join(["", *where[:depth], "tf_prefix"])
        if rospy.has_param(name):
            return str(rospy.get_param(name)).strip("/")
    return namespace.strip("/")
