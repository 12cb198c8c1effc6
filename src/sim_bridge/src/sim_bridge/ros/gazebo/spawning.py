"""Models and robots that come and go."""

from typing import Callable

import gazebo_msgs.srv as srv
import numpy as np
import rospy

from planar import PlanarError
from sim_bridge.description import RobotProfile, read_prop, read_sdf_robot, read_urdf_robot
from sim_bridge.errors import NoDriveError, UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.ros.cli import find_file
from sim_bridge.ros.fleet import Fleet
from sim_bridge.ros.gazebo.server import SCOPE_HINT, Server, frame_named
from sim_bridge.ros.messages import pose3_from_msg
from sim_bridge.scene import Scene
from sim_bridge.sdf import read_model
from sim_bridge.world import World


class SpawnServices:
    """``model_folders`` are searched for what the models spawned include."""

    def __init__(self, scene: Scene, fleet: Fleet, server: Server, model_folders):
        self._scene = scene
        self._fleet = fleet
        self._model_folders = model_folders
        server.serve("spawn_sdf_model", srv.SpawnModel, self._on_spawn_sdf)
        server.serve("spawn_urdf_model", srv.SpawnModel, self._on_spawn_urdf)
        server.serve("delete_model", srv.DeleteModel, self._on_delete)

    def _on_spawn_sdf(self, request):
        def spawn(pose):
            model = read_model(request.model_xml, request.model_name, pose, self._model_folders)
            self._add(model, request)

        return self._spawn(request, spawn)

    def _on_spawn_urdf(self, request):
        def spawn(pose):
            try:
                robot = read_urdf_robot(request.model_xml, request.model_name, find_file)
            except NoDriveError:
                self._add(read_prop(request.model_xml, request.model_name, pose, find_file), request)
            else:
                self._add_robot(request, robot, pose)

        return self._spawn(request, spawn)

    def _spawn(self, request, spawn: Callable[[np.ndarray], None]):
        name, frame = request.model_name, request.reference_frame
        if name in self._scene.models.names():
            return srv.SpawnModelResponse(False, "SpawnModel: Failure - entity already exists.")
        in_world = frame_named(self._scene, frame)
        if in_world is None:
            text = f"SpawnModel: reference reference_frame not found, {SCOPE_HINT}"
            return srv.SpawnModelResponse(False, text)
        try:
            spawn(in_world.pose @ pose3_from_msg(request.initial_pose))
        except PlanarError as error:
            return srv.SpawnModelResponse(False, f"SpawnModel: Failure - {error}")
        return srv.SpawnModelResponse(True, "SpawnModel: Successfully spawned entity")

    def _add(self, model: World, request) -> None:
        if not (model.bodies or model.robots):
            raise WorldError("; ".join([f"{request.model_name} has no links", *model.warnings]))
        for warning in model.warnings:
            rospy.logwarn("%s", warning)
        self._scene.add(model.bodies, model.joints)
        for robot in model.robots:
            self._add_robot(request, *read_sdf_robot(robot))

    def _add_robot(self, request, robot: RobotProfile, pose: np.ndarray) -> None:
        self._fleet.add(request.model_name, robot, to_pose2(pose), float(pose[2, 3]), request.robot_namespace)

    def _on_delete(self, request):
        try:
            self._fleet.remove(request.model_name)
        except UnknownEntityError:
            return srv.DeleteModelResponse(False, "DeleteModel: model does not exist")
        return srv.DeleteModelResponse(True, "DeleteModel: successfully deleted model")
