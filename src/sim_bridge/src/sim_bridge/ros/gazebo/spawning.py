"""Models and robots that come and go."""

from functools import partial
from typing import Callable, List

import gazebo_msgs.srv as srv
import numpy as np
import rospy

from planar import PlanarError
from sim_bridge.description import RobotProfile, read_prop, read_sdf_robot, read_urdf_robot
from sim_bridge.errors import NoDriveError, UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.ros.describing import find_file
from sim_bridge.ros.fleet import Fleet
from sim_bridge.ros.gazebo.server import SCOPE_HINT, Server, frame_named
from sim_bridge.ros.gazebo.spawned import Spawned
from sim_bridge.ros.messages import pose3_from_msg
from sim_bridge.scene import Scene
from sim_bridge.sdf import read_model
from sim_bridge.world import World


class SpawnRefusedError(PlanarError):
    """What Gazebo says of a call that has no model in it to complain of."""


# What there is to be done between two steps once all files have been read.
Arrivals = List[Callable[[], None]]


class SpawnServices:
    """``model_folders`` are searched for what the models spawned include.

    Files are read beside the simulation, which only puts in what has come of them.
    """

    def __init__(self, scene: Scene, fleet: Fleet, server: Server, model_folders):
        self._scene, self._fleet, self._server = scene, fleet, server
        self._model_folders = model_folders
        self._spawned = Spawned()
        server.serve_aside("spawn_sdf_model", srv.SpawnModel, partial(self._on_spawn, self._read_sdf))
        server.serve_aside("spawn_urdf_model", srv.SpawnModel, partial(self._on_spawn, self._read_urdf))
        server.serve("delete_model", srv.DeleteModel, self._on_delete)

    def _on_spawn(self, read: Callable[..., Arrivals], request):
        try:
            frame = self._server.between_steps(lambda: self._frame_of(request))
            arrivals = read(request, frame.pose @ pose3_from_msg(request.initial_pose))
            self._server.between_steps(lambda: self._put_in(request, arrivals))
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
            raise SpawnRefusedError("SpawnModel: Failure - entity already exists.")

    def _put_in(self, request, arrivals: Arrivals) -> None:
        self._check_name(request)
        for arrive in arrivals:
            arrive()

    def _read_sdf(self, request, pose: np.ndarray) -> Arrivals:
        model = read_model(request.model_xml, request.model_name, pose, self._model_folders)
        return self._arrivals(request, model, pose)

    def _read_urdf(self, request, pose: np.ndarray) -> Arrivals:
        try:
            robot = read_urdf_robot(request.model_xml, request.model_name, find_file)
        except NoDriveError:
            prop = read_prop(request.model_xml, request.model_name, pose, find_file)
            return self._arrivals(request, prop, pose)
        return [partial(self._add_robot, request, robot, pose)]

    def _arrivals(self, request, model: World, pose: np.ndarray) -> Arrivals:
        if not (model.bodies or model.robots):
            raise WorldError("; ".join([f"{request.model_name} has no links", *model.warnings]))
        for warning in model.warnings:
            rospy.logwarn("%s", warning)
        robots = [partial(self._add_robot, request, *read_sdf_robot(robot)) for robot in model.robots]
        told = (
            [partial(self._spawned.add, request.model_name, request.model_xml, pose)] if model.bodies else []
        )
        return [partial(self._scene.add, model.bodies, model.joints), *robots, *told]

    def _add_robot(self, request, robot: RobotProfile, pose: np.ndarray) -> None:
        self._fleet.add(request.model_name, robot, to_pose2(pose), float(pose[2, 3]), request.robot_namespace)

    def _on_delete(self, request):
        try:
            self._fleet.remove(request.model_name)
        except UnknownEntityError:
            return srv.DeleteModelResponse(False, "DeleteModel: model does not exist")
        self._spawned.remove(request.model_name)
        return srv.DeleteModelResponse(True, "DeleteModel: successfully deleted model")
