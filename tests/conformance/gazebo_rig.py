"""Gazebo's services on a scene, called without a ROS master."""

from pathlib import Path
from typing import Any, Callable, Dict

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion

from planar.geometry.pose import quaternion_zw
from sim_bridge import Scene, SimulationSettings
from sim_bridge.noise import NOISE_PROFILES
from sim_bridge.ros.gazebo import forces, joints, lights, physics, properties, spawning, states
from sim_bridge.sdf import load_world

WORLD = """<sdf version='1.6'><world name='w'>
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
<model name='crate'><pose>2 0 0.1 0 0 0</pose><link name='body'>
<inertial><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz></inertia></inertial>
<collision name='shell'><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model>
<model name='door'><pose>0 3 0 0 0 0</pose><link name='frame'><pose>0 0 0.1 0 0 0</pose>
<collision name='post'><geometry><box><size>0.1 0.1 0.2</size></box></geometry></collision></link>
<link name='wing'><pose>0.5 0 0.6 0 0 0</pose>
<collision name='plate'><geometry><box><size>0.8 0.04 0.9</size></box></geometry></collision></link>
<joint name='mount' type='fixed'><parent>world</parent><child>frame</child></joint>
<joint name='hinge' type='revolute'><pose>-0.4 0 0 0 0 0</pose><parent>frame</parent><child>wing</child>
<axis><xyz>0 0 1</xyz><limit><lower>-1.5</lower><upper>1.5</upper></limit></axis></joint></model>
<model name='shelf'><static>1</static><pose>5 0 0.5 0 0 1.5707963</pose><link name='board'>
<collision name='c'><geometry><box><size>1 0.3 1</size></box></geometry></collision></link></model>
</world></sdf>"""


class Time:
    """Stands for the node's control of time."""

    def __init__(self) -> None:
        self.is_paused, self.speed, self.calls = False, 1.0, []

    def __getattr__(self, name: str) -> Callable[[], None]:
        return lambda: self.calls.append(name)

    def set_speed(self, speed: float) -> None:
        self.speed = speed


class Robots:
    """Stands for the node's manager of robots: adds them to the scene, without topics."""

    def __init__(self, scene: Scene):
        self._scene, self.namespaces = scene, {}

    def add(self, name, profile, start, z=0.0, namespace="") -> None:
        self._scene.add_robot(name, profile, start, z)
        self.namespaces[name] = profile.namespace or namespace.strip("/")

    def remove(self, name: str) -> None:
        self._scene.remove_model(name)


class Publisher:
    """Records the messages of a topic, which has a subscriber."""

    made: Dict[str, "Publisher"] = {}

    def __init__(self, name: str, kind: type, **_options):
        self.kind, self.messages = kind, []
        Publisher.made[name] = self

    def publish(self, message) -> None:
        self.messages.append(message)

    def get_num_connections(self) -> int:
        return 1


class Gazebo:
    """The services and topics below /gazebo.

    Args:
        monkeypatch: Replaces what needs a ROS master.
        folder: A folder for files.
        world: SDF of the world.
    """

    def __init__(self, monkeypatch, folder: Path, world: str = WORLD):
        file = folder / "conformance.world"
        file.write_text(world)
        self._services: Dict[str, Any] = {}
        self._topics: Dict[str, Callable] = {}
        self.log = []
        monkeypatch.setattr(rospy, "Publisher", Publisher)
        monkeypatch.setattr(rospy, "logwarn", lambda text, *values: self.log.append(text % values))
        self.scene = Scene(load_world(file), SimulationSettings(**vars(NOISE_PROFILES["ideal"])))
        self.time, self.robots = Time(), Robots(self.scene)
        monkeypatch.setattr(physics, "ReconfigureServer", self._on_reconfigure_server)
        self._states = states.StateServices(self.scene, self)
        physics.PhysicsServices(self.scene, self.time, self)
        spawning.SpawnServices(self.scene, self.robots, self, [folder], False)
        for services in (
            properties.PropertyServices,
            joints.JointServices,
            forces.ForceServices,
            lights.LightServices,
        ):
            services(self.scene, self)

    def _on_reconfigure_server(self, parameters, values, on_change, namespace) -> None:
        self.parameters, self.reconfigure = {each.name: each for each in parameters}, on_change
        self.parameter_values = values

    def serve(self, name: str, kind: type, answer: Callable) -> None:
        self._services[name] = (kind, answer)

    serve_in_thread = serve

    def subscribe(self, name: str, kind: type, callback: Callable) -> None:
        self._topics[name] = callback

    def between_steps(self, function: Callable) -> Any:
        return function()

    @property
    def service_types(self) -> Dict[str, str]:
        """Types of the services by name."""
        return {name: kind._type for name, (kind, _) in self._services.items()}

    def call(self, service: str, *arguments, **fields):
        """Call a service with the fields of its request."""
        kind, answer = self._services[service]
        request = kind._request_class
        return answer(request(**dict(zip(request.__slots__, arguments)), **fields))

    def send(self, topic: str, message) -> None:
        """Receive a message on a topic."""
        self._topics[topic](message, lambda success, text: None)

    def published(self, topic: str):
        """Publish, and return the message on a topic."""
        self._states.publish()
        return Publisher.made["/gazebo/" + topic].messages[-1]

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / self.scene.step_seconds)):
            self.scene.step()


def pose_at(x=0.0, y=0.0, z=0.0, yaw=0.0) -> Pose:
    """Return a pose message."""
    return Pose(Point(x, y, z), Quaternion(0.0, 0.0, *quaternion_zw(yaw)))
