"""Advertises Gazebo's services and subscribes to its topics; reference frames of requests."""

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
# Names of the world frame.
WORLD_NAMES = ("", "world", "map", "/map")
SCOPE_HINT = "did you forget to scope the link by model name?"


class GazeboServer:
    """Handles service calls and messages between two steps of the simulation."""

    def __init__(self, calls: CallQueue):
        self._calls = calls

    def serve(self, name: str, kind, answer: Callable) -> None:
        """Advertise a service, below /gazebo unless its name starts with a slash."""
        full_name = rospy.names.ns_join(NAMESPACE, name)
        rospy.Service(full_name, kind, lambda request: self.between_steps(lambda: answer(request)))

    def serve_in_thread(self, name: str, kind, answer: Callable) -> None:
        """Advertise a service whose slow ``answer`` runs in its own thread; it must use ``between_steps``."""
        rospy.Service(rospy.names.ns_join(NAMESPACE, name), kind, answer)

    def between_steps(self, function: Callable[[], T]) -> T:
        """Run a function between two steps and return its result."""
        return self._calls.call(function)

    def subscribe(self, name: str, kind, callback: Callable) -> None:
        """Subscribe to /gazebo/``name``.

        Args:
            name: Of the topic.
            kind: Type of its messages.
            callback: Called with a message and a function (success, text) that logs a failure.
        """

        def on_message(message):
            self._calls.submit(lambda: callback(message, _log_failure))

        rospy.Subscriber(NAMESPACE + name, kind, on_message, queue_size=10)


def frame_named(scene: Scene, name: str) -> Optional[KinematicState]:
    """Return the state of a model or link, or of the world frame; None if there is none of that name."""
    if name in WORLD_NAMES:
        return KinematicState(np.eye(4), np.zeros(3), np.zeros(3))
    try:
        if name in scene.models.names():
            return scene.models.state(name)
        return scene.models.link_state(scene.models.full_link_name(name))
    except UnknownEntityError:
        return None


def relative(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """Transform a state from the world to a frame, with the velocity relative to that of the frame."""
    world_to_frame = frame.pose[:3, :3].T
    return KinematicState(
        inverse(frame.pose) @ motion.pose,
        world_to_frame @ (motion.linear - frame.linear),
        world_to_frame @ (motion.angular - frame.angular),
    )


def absolute(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """Transform a state from a frame to the world; its velocity is absolute, along the axes of the frame."""
    rotation = frame.pose[:3, :3]
    return KinematicState(frame.pose @ motion.pose, rotation @ motion.linear, rotation @ motion.angular)


def _log_failure(success: bool, text: str) -> None:
    if not success:
        rospy.logwarn("%s", text)
