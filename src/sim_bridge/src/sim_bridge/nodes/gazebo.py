"""Gazebo's services and topics below /gazebo (gazebo_ros 2.9), with its status texts."""

from collections import Counter
from typing import Callable, Optional

import gazebo_msgs.srv as srv
import numpy as np
import rospy
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates, ODEPhysics
from geometry_msgs.msg import Vector3
from std_srvs.srv import Empty, EmptyResponse

from planar import PlanarError
from sim_bridge.cli import find_file
from sim_bridge.description import RobotProfile, read_prop, read_sdf_robot, read_urdf_robot
from sim_bridge.engine import Motion
from sim_bridge.errors import NoDriveError, UnknownEntityError, WorldError
from sim_bridge.nodes.fleet import Fleet
from sim_bridge.nodes.messages import (
    motion_from_msgs,
    motion_to_msgs,
    pose3_from_msg,
    vector_from_msg,
)
from sim_bridge.nodes.orders import Orders
from sim_bridge.nodes.time_control import TimeControl
from sim_bridge.pose3 import cross, to_pose2
from sim_bridge.scene import Push, Scene
from sim_bridge.sdf import read_model
from sim_bridge.world import World

NAMESPACE = "/gazebo/"
# Names that all mean the world.
WORLD_NAMES = ("", "world", "map", "/map")
SCOPE_HINT = "did you forget to scope the link by model name?"


class GazeboInterface:
    """Serves a scene as Gazebo does; ``model_folders`` are searched for the models of spawned ones."""

    def __init__(self, scene: Scene, fleet: Fleet, time_control: TimeControl, orders: Orders, model_folders):
        self._scene = scene
        self._fleet = fleet
        self._time = time_control
        self._orders = orders
        self._model_folders = model_folders
        self._asked: Counter = Counter()
        self._model_states = rospy.Publisher(NAMESPACE + "model_states", ModelStates, queue_size=10)
        self._link_states = rospy.Publisher(NAMESPACE + "link_states", LinkStates, queue_size=10)
        for topic, kind, set_state in (
            ("set_model_state", ModelState, self._set_model),
            ("set_link_state", LinkState, self._set_link),
        ):
            rospy.Subscriber(NAMESPACE + topic, kind, self._on_state, set_state, queue_size=10)
        self._serve_time()
        self._serve_world()
        self._serve_models()

    def publish(self) -> None:
        """Where all models and links are, for those who have subscribed."""
        scene = self._scene
        if self._model_states.get_num_connections():
            message = ModelStates(name=scene.model_names())
            self._fill(message, [scene.model_motion(name) for name in message.name])
            self._model_states.publish(message)
        if self._link_states.get_num_connections():
            message = LinkStates(
                name=[link for model in scene.model_names() for link in scene.links_of(model)]
            )
            self._fill(message, [scene.link_motion(name) for name in message.name])
            self._link_states.publish(message)

    def _fill(self, message, motions):
        for motion in motions:
            pose, twist = motion_to_msgs(motion)
            message.pose.append(pose)
            message.twist.append(twist)

    def _serve(self, name: str, kind, answer: Callable):
        """A service that is answered between two steps."""
        rospy.Service(NAMESPACE + name, kind, lambda request: self._orders.ask(lambda: answer(request)))

    def _serve_time(self):
        for name, do in (
            ("pause_physics", self._time.pause),
            ("unpause_physics", self._time.unpause),
            ("reset_world", self._time.reset_world),
            ("reset_simulation", self._time.reset_simulation),
        ):
            self._serve(name, Empty, lambda _request, do=do: (do(), EmptyResponse())[1])

    def _serve_world(self):
        self._serve("get_world_properties", srv.GetWorldProperties, self._on_get_world)
        self._serve("get_physics_properties", srv.GetPhysicsProperties, self._on_get_physics)
        self._serve("set_physics_properties", srv.SetPhysicsProperties, self._on_set_physics)

    def _serve_models(self):
        self._serve("spawn_sdf_model", srv.SpawnModel, self._on_spawn_sdf)
        self._serve("spawn_urdf_model", srv.SpawnModel, self._on_spawn_urdf)
        self._serve("delete_model", srv.DeleteModel, self._on_delete_model)
        self._serve("get_model_state", srv.GetModelState, self._on_get_model_state)
        self._serve("set_model_state", srv.SetModelState, self._on_set_model_state)
        self._serve("get_model_properties", srv.GetModelProperties, self._on_get_model_properties)
        self._serve("get_link_state", srv.GetLinkState, self._on_get_link_state)
        self._serve("set_link_state", srv.SetLinkState, self._on_set_link_state)
        self._serve("apply_body_wrench", srv.ApplyBodyWrench, self._on_apply_wrench)
        self._serve("clear_body_wrenches", srv.BodyRequest, self._on_clear_wrenches)

    def _on_get_world(self, _request):
        return srv.GetWorldPropertiesResponse(
            sim_time=self._scene.stamp,
            model_names=self._scene.model_names(),
            rendering_enabled=False,
            success=True,
            status_message="GetWorldProperties: got properties",
        )

    def _on_get_physics(self, _request):
        rate = self._scene.settings.physics_rate
        return srv.GetPhysicsPropertiesResponse(
            time_step=1.0 / rate,
            pause=self._time.is_paused,
            max_update_rate=rate * self._time.speed,
            gravity=Vector3(0.0, 0.0, -self._scene.gravity),
            ode_config=ODEPhysics(),
            success=True,
            status_message="GetPhysicsProperties: got properties",
        )

    def _on_set_physics(self, request):
        """A target of 0 updates a second means as fast as possible, here as there."""
        try:
            gravity = request.gravity
            if gravity.x or gravity.y or not np.isfinite(gravity.z):
                raise WorldError("gravity must point along the z axis")
            if not (request.time_step > 0.0 and 0.0 <= request.max_update_rate < np.inf):
                raise WorldError("time_step must be positive, max_update_rate not negative")
            self._scene.set_physics_rate(round(1.0 / request.time_step))
            self._scene.set_gravity(-gravity.z)
            self._time.set_speed(request.max_update_rate * request.time_step)
        except PlanarError as error:
            return srv.SetPhysicsPropertiesResponse(False, f"SetPhysicsProperties: {error}")
        return srv.SetPhysicsPropertiesResponse(True, "physics engine updated")

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
        if name in self._scene.model_names():
            return srv.SpawnModelResponse(False, "SpawnModel: Failure - entity already exists.")
        in_world = self._frame(frame)
        if in_world is None:
            text = f"SpawnModel: reference reference_frame not found, {SCOPE_HINT}"
            return srv.SpawnModelResponse(False, text)
        try:
            spawn(in_world.pose @ pose3_from_msg(request.initial_pose))
        except PlanarError as error:
            return srv.SpawnModelResponse(False, f"SpawnModel: Failure - {error}")
        return srv.SpawnModelResponse(True, "SpawnModel: Successfully spawned entity")

    def _add(self, model: World, request) -> None:
        for warning in model.warnings:
            rospy.logwarn("%s", warning)
        self._scene.add(model.bodies)
        for robot in model.robots:
            self._add_robot(request, *read_sdf_robot(robot))

    def _add_robot(self, request, robot: RobotProfile, pose: np.ndarray) -> None:
        self._fleet.add(request.model_name, robot, to_pose2(pose), float(pose[2, 3]), request.robot_namespace)

    def _on_delete_model(self, request):
        try:
            self._fleet.remove(request.model_name)
        except UnknownEntityError:
            return srv.DeleteModelResponse(False, "DeleteModel: model does not exist")
        return srv.DeleteModelResponse(True, "DeleteModel: successfully deleted model")

    def _on_get_model_state(self, request):
        response = srv.GetModelStateResponse()
        response.header.stamp = rospy.Time.from_sec(self._scene.stamp)
        response.header.frame_id = request.relative_entity_name
        try:
            motion = self._scene.model_motion(request.model_name)
        except UnknownEntityError:
            response.status_message = "GetModelState: model does not exist"
            return response
        self._asked[request.model_name] += 1
        response.header.seq = self._asked[request.model_name]
        frame = self._frame(request.relative_entity_name)
        if frame is None:
            response.status_message = (
                "GetModelState: reference relative_entity_name not found, "
                "did you forget to scope the body by model name?"
            )
            return response
        response.pose, response.twist = motion_to_msgs(_relative(motion, frame))
        response.success, response.status_message = True, "GetModelState: got properties"
        return response

    def _on_set_model_state(self, request):
        return self._set_model(request.model_state, srv.SetModelStateResponse)

    def _set_model(self, state: ModelState, answer):
        if state.model_name not in self._scene.model_names():
            return answer(False, "SetModelState: model does not exist")
        frame = self._frame(state.reference_frame)
        if frame is None:
            return answer(False, "SetModelState: specified reference frame entity does not exist")
        try:
            motion = _absolute(motion_from_msgs(state.pose, state.twist), frame)
            self._scene.set_model_motion(state.model_name, motion)
        except WorldError as error:
            return answer(False, f"SetModelState: {error}")
        return answer(True, "SetModelState: set model state done")

    def _on_get_model_properties(self, request):
        scene, model = self._scene, request.model_name
        if model not in scene.model_names():
            return srv.GetModelPropertiesResponse(
                success=False, status_message="GetModelProperties: model does not exist"
            )
        links = [link.split("::", 1)[1] for link in scene.links_of(model)]
        return srv.GetModelPropertiesResponse(
            canonical_body_name=links[0],
            body_names=links,
            is_static=scene.is_static(model),
            success=True,
            status_message="GetModelProperties: got properties",
        )

    def _on_get_link_state(self, request):
        response = srv.GetLinkStateResponse()
        response.link_state.link_name = request.link_name
        response.link_state.reference_frame = request.reference_frame
        try:
            motion = self._scene.link_motion(request.link_name)
        except UnknownEntityError:
            response.status_message = f"GetLinkState: link not found, {SCOPE_HINT}"
            return response
        frame = self._frame(request.reference_frame)
        if frame is None:
            response.status_message = f"GetLinkState: reference reference_frame not found, {SCOPE_HINT}"
            return response
        response.link_state.pose, response.link_state.twist = motion_to_msgs(_relative(motion, frame))
        response.success, response.status_message = True, "GetLinkState: got state"
        return response

    def _on_set_link_state(self, request):
        return self._set_link(request.link_state, srv.SetLinkStateResponse)

    def _set_link(self, state: LinkState, answer):
        frame = self._frame(state.reference_frame)
        if frame is None:
            return answer(False, "SetLinkState: failed")
        try:
            motion = _absolute(motion_from_msgs(state.pose, state.twist), frame)
            self._scene.set_link_motion(state.link_name, motion)
        except UnknownEntityError:
            return answer(False, "SetLinkState: link does not exist")
        except WorldError as error:
            return answer(False, f"SetLinkState: {error}")
        return answer(True, "SetLinkState: success")

    def _on_apply_wrench(self, request):
        frame = self._frame(request.reference_frame)
        if frame is None:
            return srv.ApplyBodyWrenchResponse(False, "ApplyBodyWrench: reference_frame not found")
        try:
            link = self._scene.link_motion(request.body_name)
        except UnknownEntityError:
            return srv.ApplyBodyWrenchResponse(False, "ApplyBodyWrench: body does not exist")
        turned = frame.pose[:3, :3]
        force = turned @ vector_from_msg(request.wrench.force)
        torque = turned @ vector_from_msg(request.wrench.torque)
        if any(request.reference_frame == name for name in WORLD_NAMES):
            arm = turned @ vector_from_msg(request.reference_point)
        else:
            point = frame.pose[:3, 3] + turned @ vector_from_msg(request.reference_point)
            arm = point - link.pose[:3, 3]
        if not np.isfinite(np.concatenate((force, torque, arm))).all():
            return srv.ApplyBodyWrenchResponse(False, "ApplyBodyWrench: the wrench is not finite")
        start, duration = max(request.start_time.to_sec(), self._scene.stamp), request.duration.to_sec()
        end = np.inf if duration < 0.0 else start + duration
        self._scene.push(Push(request.body_name, force, torque + cross(arm, force), start, end))
        return srv.ApplyBodyWrenchResponse(True, "")

    def _on_clear_wrenches(self, request):
        self._scene.stop_pushing(request.body_name)
        return srv.BodyRequestResponse()

    def _on_state(self, message, set_state):
        """A state that has come by topic; what is wrong with it is told, as nobody waits for the answer."""

        def apply():
            set_state(message, _tell_failure)

        self._orders.leave(apply)

    def _frame(self, name: str) -> Optional[Motion]:
        """The motion of the link or model of that name, or of the world; None if there is none."""
        if name in WORLD_NAMES:
            return Motion(np.eye(4), np.zeros(3), np.zeros(3))
        try:
            return self._scene.link_motion(name) if "::" in name else self._scene.model_motion(name)
        except UnknownEntityError:
            return None


def _tell_failure(success: bool, text: str) -> None:
    if not success:
        rospy.logwarn("%s", text)


def _relative(motion: Motion, frame: Motion) -> Motion:
    turned_back = frame.pose[:3, :3].T
    return Motion(
        np.linalg.inv(frame.pose) @ motion.pose,
        turned_back @ (motion.linear - frame.linear),
        turned_back @ (motion.angular - frame.angular),
    )


def _absolute(motion: Motion, frame: Motion) -> Motion:
    turned = frame.pose[:3, :3]
    return Motion(frame.pose @ motion.pose, turned @ motion.linear, turned @ motion.angular)
