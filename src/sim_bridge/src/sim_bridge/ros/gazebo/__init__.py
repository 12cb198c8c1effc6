"""Gazebo's services and topics below /gazebo (gazebo_ros 2.9) with its status texts, and a link attacher."""

from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.gazebo.forces import ForceServices
from sim_bridge.ros.gazebo.joints import JointServices
from sim_bridge.ros.gazebo.lights import LightServices
from sim_bridge.ros.gazebo.link_attacher import AttachServices
from sim_bridge.ros.gazebo.physics import PhysicsServices
from sim_bridge.ros.gazebo.properties import PropertyServices
from sim_bridge.ros.gazebo.server import GazeboServer
from sim_bridge.ros.gazebo.spawning import SpawnServices
from sim_bridge.ros.gazebo.states import StateServices
from sim_bridge.ros.robot_manager import RobotManager
from sim_bridge.ros.timing.time_control import TimeControl
from sim_bridge.scene import Scene

__all__ = ["GazeboInterface"]


class GazeboInterface:
    """Services and topics of Gazebo.

    Args:
        scene: The simulated world.
        robots: Steps the scene; spawned robots are added to it.
        time_control: Pauses, steps and resets simulated time.
        calls: Queue of the thread that owns the scene.
        model_folders: Folders of the models that spawned ones include.
        strict: Refuse models with content that has no effect.
    """

    def __init__(
        self,
        scene: Scene,
        robots: RobotManager,
        time_control: TimeControl,
        calls: CallQueue,
        model_folders,
        strict: bool = False,
    ):
        server = GazeboServer(calls)
        self._states = StateServices(scene, server)
        PhysicsServices(scene, time_control, server)
        SpawnServices(scene, robots, server, model_folders, strict)
        PropertyServices(scene, server)
        JointServices(scene, server)
        ForceServices(scene, server)
        LightServices(scene, server)
        AttachServices(scene, server)

    def publish(self) -> None:
        """Publish model_states and link_states if they have subscribers."""
        self._states.publish()
