"""Services that apply wrenches to links and efforts to joints."""

import contextlib

import gazebo_msgs.srv as srv
import numpy as np

from sim_bridge.errors import UnknownEntityError
from sim_bridge.geometry.pose3 import cross
from sim_bridge.physics.forces import JointEffort, LinkWrench
from sim_bridge.ros.gazebo.server import WORLD_NAMES, GazeboServer, frame_named
from sim_bridge.ros.messages import vector_from_msg
from sim_bridge.scene import Scene


class ForceServices:
    def __init__(self, scene: Scene, server: GazeboServer):
        self._scene = scene
        server.serve("apply_body_wrench", srv.ApplyBodyWrench, self._on_apply_wrench)
        server.serve("clear_body_wrenches", srv.BodyRequest, self._on_clear_wrenches)
        server.serve("apply_joint_effort", srv.ApplyJointEffort, self._on_apply_effort)
        server.serve("clear_joint_forces", srv.JointRequest, self._on_clear_efforts)

    def _on_apply_wrench(self, request):
        answer = srv.ApplyBodyWrenchResponse
        try:
            name = self._scene.models.full_link_name(request.body_name)
        except UnknownEntityError:
            return answer(False, "ApplyBodyWrench: body does not exist")
        frame = frame_named(self._scene, request.reference_frame)
        if frame is None:
            return answer(False, "ApplyBodyWrench: reference_frame not found")
        link, turned = self._scene.models.link_state(name), frame.pose[:3, :3]
        force = turned @ vector_from_msg(request.wrench.force)
        torque = turned @ vector_from_msg(request.wrench.torque)
        if request.reference_frame in WORLD_NAMES:
            arm = turned @ vector_from_msg(request.reference_point)
        else:
            point = frame.pose[:3, 3] + turned @ vector_from_msg(request.reference_point)
            arm = point - link.pose[:3, 3]
        if not np.isfinite(np.concatenate((force, torque, arm))).all():
            return answer(False, "ApplyBodyWrench: the wrench is not finite")
        span = self._span(request)
        self._scene.forces.apply_link_wrench(LinkWrench(name, force, torque + cross(arm, force), *span))
        return answer(True, "")

    def _on_clear_wrenches(self, request):
        self._scene.forces.clear_link_wrenches(request.body_name)
        return srv.BodyRequestResponse()

    def _on_apply_effort(self, request):
        answer = srv.ApplyJointEffortResponse
        try:
            name = self._scene.joints.full_name(request.joint_name)
        except UnknownEntityError:
            return answer(False, "ApplyJointEffort: joint not found")
        if not np.isfinite(request.effort):
            return answer(False, "ApplyJointEffort: the effort is not finite")
        self._scene.forces.apply_joint_effort(JointEffort(name, request.effort, *self._span(request)))
        return answer(True, "ApplyJointEffort: effort set")

    def _on_clear_efforts(self, request):
        # The response has no field for an error.
        with contextlib.suppress(UnknownEntityError):
            self._scene.forces.clear_joint_efforts(self._scene.joints.full_name(request.joint_name))
        return srv.JointRequestResponse()

    def _span(self, request):
        """Return start, not before now, and end [simulated s]; a negative duration has no end."""
        start, duration = max(request.start_time.to_sec(), self._scene.stamp), request.duration.to_sec()
        return start, np.inf if duration < 0.0 else start + duration
