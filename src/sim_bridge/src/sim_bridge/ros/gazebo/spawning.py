"""Services that spawn and delete models and robots."""

from dataclasses import replace
from functools import partial
from typing import Callable, Dict, List, Sequence

import gazebo_msgs.srv as srv
import numpy as np
import rospy
from sim_bridge_msgs.msg import SpawnedModel, SpawnedModels

from planar import PlanarError
from planar_ros.node.parameters import report_without_effect
from sim_bridge.description import RobotProfile, read_prop, read_sdf_robot, read_urdf_robot
from sim_bridge.errors import NoDriveError, UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.ros.description import find_file
from sim_bridge.ros.gazebo.server import SCOPE_HINT, GazeboServer, frame_named
from sim_bridge.ros.messages import pose3_from_msg, pose3_to_msg
from sim_bridge.ros.robot_manager import RobotManager
from sim_bridge.scene import Scene
from sim_bridge.sdf import read_model
from sim_bridge.sdf.element import parse_text
from sim_bridge.sdf.lights import read_light
from sim_bridge.world import Light, World

ALREADY_EXISTS = "SpawnModel: Failure - entity already exists."


class SpawnRefusedError(PlanarError):
    """A call that Gazebo refuses before it reads the model; the text is Gazebo's."""


# Calls that put models into the scene between two steps, once all files have been read.
Insertions = List[Callable[[], None]]


class SpawnServices:
    """Services spawn_sdf_model, spawn_urdf_model and delete_model.

    Files are read in the thread of the call while the simulation runs; only the result is inserted between
    two steps.

    Args:
        scene: The simulated world.
        robots: Spawned robots are added to it.
        server: Advertises the services.
        model_folders: Folders of the models that spawned ones include.
        strict: Refuse models with content that has no effect.
    """

    def __init__(self, scene: Scene, robots: RobotManager, server: GazeboServer, model_folders, strict: bool):
        self._scene, self._robots, self._server = scene, robots, server
        self._model_folders, self._strict = model_folders, strict
        self._spawned = SpawnedModelsPublisher()
        server.serve_in_thread("spawn_sdf_model", srv.SpawnModel, partial(self._on_spawn, self._read))
        server.serve_in_thread("spawn_urdf_model", srv.SpawnModel, partial(self._on_spawn, self._read_urdf))
        server.serve("delete_model", srv.DeleteModel, self._on_delete)

    def _on_spawn(self, read: Callable[..., Insertions], request):
        try:
            frame = self._server.between_steps(lambda: self._frame_of(request))
            insertions = read(request, frame.pose @ pose3_from_msg(request.initial_pose))
            self._server.between_steps(lambda: self._put_in(request, insertions))
        except SpawnRefusedError as error:
            return srv.SpawnModelResponse(False, str(error))
        except PlanarError as error:
            return srv.SpawnModelResponse(False, f"SpawnModel: Failure - {error}")
        return srv.SpawnModelResponse(True, "SpawnModel: Successfully spawned entity")

    def _frame_of(self, request) -> KinematicState:
        self._check_name(request)
        frame = frame_named(self._scene, request.reference_frame)
        if frame is None:
            raise SpawnRefusedError(f"SpawnModel: reference reference_frame not found, {SCOPE_HINT}")
        return frame

    def _check_name(self, request) -> None:
        if request.model_name in self._scene.models.names():
            raise SpawnRefusedError(ALREADY_EXISTS)

    def _put_in(self, request, insertions: Insertions) -> None:
        self._check_name(request)
        for insert in insertions:
            insert()

    def _read(self, request, pose: np.ndarray) -> Insertions:
        """Read SDF, or URDF, which Gazebo accepts here, too."""
        root = parse_text(request.model_xml, request.model_name, ("sdf", "gazebo", "robot"))
        if root.tag == "robot":
            return self._read_urdf(request, pose)
        light = root.child("light")
        if light is not None and root.child("model") is None:
            return [partial(self._add_light, replace(read_light(light), name=request.model_name))]
        model = read_model(request.model_xml, request.model_name, pose, self._model_folders, self._strict)
        return self._insertions(request, model, pose)

    def _add_light(self, light: Light) -> None:
        if light.name in self._scene.lights:
            raise SpawnRefusedError(ALREADY_EXISTS)
        self._scene.lights[light.name] = light

    def _read_urdf(self, request, pose: np.ndarray) -> Insertions:
        try:
            robot = read_urdf_robot(request.model_xml, request.model_name, find_file)
        except NoDriveError:
            prop = read_prop(request.model_xml, request.model_name, pose, find_file)
            return self._insertions(request, prop, pose)
        self._report(robot.warnings)
        return [partial(self._add_robot, request, robot, pose)]

    def _report(self, warnings: Sequence[str]) -> None:
        report_without_effect([], warnings, self._strict, WorldError, "strict")

    def _insertions(self, request, model: World, pose: np.ndarray) -> Insertions:
        if not (model.bodies or model.robots):
            raise WorldError("; ".join([f"{request.model_name} has no links", *model.warnings]))
        driven = [read_sdf_robot(robot) for robot in model.robots]
        warnings = [text for profile, _ in driven for text in profile.warnings]
        self._report([*model.warnings, *warnings])
        robots = [partial(self._add_robot, request, *robot) for robot in driven]
        insertions: Insertions = [partial(self._scene.add, model.bodies, model.joints), *robots]
        if model.bodies:
            insertions.append(partial(self._spawned.add, request.model_name, request.model_xml, pose))
        return insertions

    def _add_robot(self, request, robot: RobotProfile, pose: np.ndarray) -> None:
        self._robots.add(
            request.model_name, robot, to_pose2(pose), float(pose[2, 3]), request.robot_namespace
        )

    def _on_delete(self, request):
        try:
            self._robots.remove(request.model_name)
        except UnknownEntityError:
            return srv.DeleteModelResponse(False, "DeleteModel: model does not exist")
        self._spawned.remove(request.model_name)
        return srv.DeleteModelResponse(True, "DeleteModel: successfully deleted model")


class SpawnedModelsPublisher:
    """Publishes the models that are not in the world's file, for viewers that read that file."""

    def __init__(self) -> None:
        self._models: Dict[str, SpawnedModel] = {}
        self._publisher = rospy.Publisher("~spawned", SpawnedModels, queue_size=1, latch=True)

    def add(self, name: str, xml: str, pose: np.ndarray) -> None:
        """Add a model.

        Args:
            name: Name of the model.
            xml: Its SDF or URDF text.
            pose: Pose (4, 4) in the world.
        """
        self._models[name] = SpawnedModel(name, xml, pose3_to_msg(pose))
        self._publish()

    def remove(self, name: str) -> None:
        """Remove a model if it was spawned."""
        if self._models.pop(name, None) is not None:
            self._publish()

    def _publish(self) -> None:
        self._publisher.publish(SpawnedModels(list(self._models.values())))
