"""How Gazebo's services are offered, and in which frames they are told of."""

from typing import Callable, Optional, TypeVar

import numpy as np
import rospy

from sim_bridge.errors import UnknownEntityError
from sim_bridge.geometry.pose3 import inverse
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.scene import Scene

T = TypeVar("T")

NAMESPACE = "/gazebo/"
# Names that all mean the world.
WORLD_NAMES = ("", "world", "map", "/map")
SCOPE_HINT = "did you forget to scope the link by model name?"


class GazeboServer:
    """Answers calls, and takes what comes by topic, between two steps of the simulation."""

    def __init__(self, calls: CallQueue):
        self._calls = calls

    def serve(self, name: str, kind, answer: Callable) -> None:
        """The service ``name``, below /gazebo unless it begins with a slash."""
        full_name = rospy.names.ns_join(NAMESPACE, name)
        rospy.Service(full_name, kind, lambda request: self.between_steps(lambda: answer(request)))

    def serve_in_thread(self, name: str, kind, answer: Callable) -> None:
        """The same for an ``answer`` that takes its time: it runs in a thread beside the simulation.

        What it does to the scene it has done ``between_steps``.
        """
        rospy.Service(rospy.names.ns_join(NAMESPACE, name), kind, answer)

    def between_steps(self, do: Callable[[], T]) -> T:
        """Has ``do`` called between two steps and returns what it returns."""
        return self._calls.call(do)

    def listen(self, name: str, kind, take: Callable) -> None:
        """The topic /gazebo/``name``; ``take`` is called with a message and what tells a failure."""

        def on_message(message):
            self._calls.submit(lambda: take(message, _tell_failure))

        rospy.Subscriber(NAMESPACE + name, kind, on_message, queue_size=10)


def frame_named(scene: Scene, name: str) -> Optional[KinematicState]:
    """The motion of the model or link of that name, or of the world; None if there is none."""
    if name in WORLD_NAMES:
        return KinematicState(np.eye(4), np.zeros(3), np.zeros(3))
    try:
        if name in scene.models.names():
            return scene.models.state(name)
        return scene.models.link_state(scene.models.full_link_name(name))
    except UnknownEntityError:
        return None


def relative(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """A motion in the world as seen from a frame."""
    turned_back = frame.pose[:3, :3].T
    return KinematicState(
        inverse(frame.pose) @ motion.pose,
        turned_back @ (motion.linear - frame.linear),
        turned_back @ (motion.angular - frame.angular),
    )


def absolute(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """A motion given in a frame as seen from the world; only the axes of its velocities are the frame's."""
    turned = frame.pose[:3, :3]
    return KinematicState(frame.pose @ motion.pose, turned @ motion.linear, turned @ motion.angular)


def _tell_failure(success: bool, text: str) -> None:
    if not success:
        rospy.logwarn("%s", text)
