"""Services and topics that get and set poses and twists of models and links."""

from collections import Counter

import gazebo_msgs.srv as srv
import rospy
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates

from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.ros.gazebo.server import NAMESPACE, SCOPE_HINT, GazeboServer, absolute, frame_named, relative
from sim_bridge.ros.messages import state_from_msgs, state_to_msgs
from sim_bridge.scene import Scene


class StateServices:
    def __init__(self, scene: Scene, server: GazeboServer):
        self._scene = scene
        self._request_counts: Counter = Counter()
        self._models = rospy.Publisher(NAMESPACE + "model_states", ModelStates, queue_size=10)
        self._links = rospy.Publisher(NAMESPACE + "link_states", LinkStates, queue_size=10)
        server.serve("get_model_state", srv.GetModelState, self._on_get_model)
        server.serve("get_link_state", srv.GetLinkState, self._on_get_link)
        server.serve(
            "set_model_state",
            srv.SetModelState,
            lambda request: self._set_model(request.model_state, srv.SetModelStateResponse),
        )
        server.serve(
            "set_link_state",
            srv.SetLinkState,
            lambda request: self._set_link(request.link_state, srv.SetLinkStateResponse),
        )
        server.subscribe("set_model_state", ModelState, self._set_model)
        server.subscribe("set_link_state", LinkState, self._set_link)

    def publish(self) -> None:
        """Publish model_states and link_states if they have subscribers."""
        scene = self._scene
        if self._models.get_num_connections():
            message = ModelStates(name=scene.models.names())
            _fill(message, [scene.models.state(name) for name in message.name])
            self._models.publish(message)
        if self._links.get_num_connections():
            message = LinkStates(
                name=[link for model in scene.models.names() for link in scene.models.links_of(model)]
            )
            _fill(message, [scene.models.link_state(name) for name in message.name])
            self._links.publish(message)

    def _on_get_model(self, request):
        response = srv.GetModelStateResponse()
        try:
            motion = self._scene.models.state(request.model_name)
        except UnknownEntityError:
            response.status_message = "GetModelState: model does not exist"
            return response
        response.header.stamp = rospy.Time.from_sec(self._scene.stamp)
        response.header.frame_id = request.relative_entity_name
        self._request_counts[request.model_name] += 1
        response.header.seq = self._request_counts[request.model_name]
        frame = frame_named(self._scene, request.relative_entity_name)
        if frame is None:
            response.status_message = (
                "GetModelState: reference relative_entity_name not found, "
                "did you forget to scope the body by model name?"
            )
            return response
        response.pose, response.twist = state_to_msgs(relative(motion, frame))
        response.success, response.status_message = True, "GetModelState: got properties"
        return response

    def _on_get_link(self, request):
        response = srv.GetLinkStateResponse()
        try:
            motion = self._scene.models.link_state(self._scene.models.full_link_name(request.link_name))
        except UnknownEntityError:
            response.status_message = f"GetLinkState: link not found, {SCOPE_HINT}"
            return response
        frame = frame_named(self._scene, request.reference_frame)
        if frame is None:
            response.status_message = f"GetLinkState: reference reference_frame not found, {SCOPE_HINT}"
            return response
        response.link_state.link_name = request.link_name
        response.link_state.reference_frame = request.reference_frame
        response.link_state.pose, response.link_state.twist = state_to_msgs(relative(motion, frame))
        response.success, response.status_message = True, "GetLinkState: got state"
        return response

    def _set_model(self, state: ModelState, answer):
        if state.model_name not in self._scene.models.names():
            return answer(False, "SetModelState: model does not exist")
        frame = frame_named(self._scene, state.reference_frame)
        if frame is None:
            return answer(False, "SetModelState: specified reference frame entity does not exist")
        try:
            motion = absolute(state_from_msgs(state.pose, state.twist), frame)
            self._scene.set_model_state(state.model_name, motion)
        except WorldError as error:
            return answer(False, f"SetModelState: {error}")
        return answer(True, "SetModelState: set model state done")

    def _set_link(self, state: LinkState, answer):
        try:
            link = self._scene.models.full_link_name(state.link_name)
        except UnknownEntityError:
            return answer(False, "SetLinkState: link does not exist")
        frame = frame_named(self._scene, state.reference_frame)
        if frame is None:
            return answer(False, "SetLinkState: failed")
        try:
            self._scene.models.set_link_state(link, absolute(state_from_msgs(state.pose, state.twist), frame))
        except WorldError as error:
            return answer(False, f"SetLinkState: {error}")
        return answer(True, "SetLinkState: success")


def _fill(message, motions) -> None:
    for motion in motions:
        pose, twist = state_to_msgs(motion)
        message.pose.append(pose)
        message.twist.append(twist)
