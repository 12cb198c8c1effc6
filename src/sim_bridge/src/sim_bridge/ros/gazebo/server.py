"""Advertises Gazebo's services and subscribes to its topics; reference frames of requests."""

from typing import Callable, Optional, TypeVar

import numpy as np
import rospy
from rosgraph.names import ns_join

from planar_ros.lockstep.transport import is_read_only
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
    """Handles service calls and messages between two steps of the simulation.

    Args:
        calls: Queue of the thread that owns the scene.
    """

    def __init__(self, calls: CallQueue):
        self._calls = calls

    def serve(self, name: str, kind, answer: Callable) -> None:
        """Advertise a service that is handled between two steps.

        Args:
            name: Name of the service, below /gazebo unless it starts with a slash.
            kind: Type of the service.
            answer: Returns the response to a request.
        """
        full_name, acts = ns_join(NAMESPACE, name), not is_read_only(name)
        rospy.Service(full_name, kind, lambda request: self._calls.call(lambda: answer(request), acts))

    def serve_in_thread(self, name: str, kind, answer: Callable) -> None:
        """Advertise a slow service that is handled in its own thread, while the simulation runs.

        Args:
            name: Name of the service, below /gazebo.
            kind: Type of the service.
            answer: Returns the response to a request; must access the scene by ``between_steps``.
        """
        rospy.Service(ns_join(NAMESPACE, name), kind, answer)

    def between_steps(self, function: Callable[[], T]) -> T:
        """Run a function between two steps and return its result."""
        return self._calls.call(function)

    def subscribe(self, name: str, kind, callback: Callable) -> None:
        """Subscribe to a topic whose messages are handled between two steps.

        Args:
            name: Name of the topic, below /gazebo.
            kind: Type of its messages.
            callback: Called with a message and a function (success, text) that logs a failure.
        """

        def on_message(message):
            self._calls.submit(lambda: callback(message, _log_failure))

        rospy.Subscriber(NAMESPACE + name, kind, on_message, queue_size=10)


def frame_named(scene: Scene, name: str) -> Optional[KinematicState]:
    """Return the state of a reference frame in the world.

    Args:
        scene: The simulated world.
        name: Name of a model or link, or one of WORLD_NAMES.

    Returns:
        The state; None if there is no such frame.
    """
    if name in WORLD_NAMES:
        return KinematicState(np.eye(4), np.zeros(3), np.zeros(3))
    try:
        if name in scene.models.names():
            return scene.models.state(name)
        return scene.models.link_state(scene.models.full_link_name(name))
    except UnknownEntityError:
        return None


def relative(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """Transform a state from the world to a frame.

    Args:
        motion: Pose and velocity in the world.
        frame: Pose and velocity of the frame in the world.

    Returns:
        The pose in the frame, and the velocity relative to the frame's, along its axes.
    """
    world_to_frame = frame.pose[:3, :3].T
    return KinematicState(
        inverse(frame.pose) @ motion.pose,
        world_to_frame @ (motion.linear - frame.linear),
        world_to_frame @ (motion.angular - frame.angular),
    )


def absolute(motion: KinematicState, frame: KinematicState) -> KinematicState:
    """Transform a state from a frame to the world.

    Args:
        motion: Pose in the frame, and absolute velocity along its axes.
        frame: Pose of the frame in the world.

    Returns:
        Pose and velocity in the world.
    """
    rotation = frame.pose[:3, :3]
    return KinematicState(frame.pose @ motion.pose, rotation @ motion.linear, rotation @ motion.angular)


def _log_failure(success: bool, text: str) -> None:
    if not success:
        rospy.logwarn("%s", text)
