"""Services that get and set properties and positions of joints."""

import gazebo_msgs.srv as srv
import numpy as np

from sim_bridge.errors import UnknownEntityError
from sim_bridge.ros.gazebo.server import GazeboServer
from sim_bridge.scene import Scene

KINDS = {
    "revolute": srv.GetJointPropertiesResponse.REVOLUTE,
    "prismatic": srv.GetJointPropertiesResponse.PRISMATIC,
    "fixed": srv.GetJointPropertiesResponse.FIXED,
}


class JointServices:
    """Joints are named ``joint`` or ``model::joint``, as in Gazebo."""

    def __init__(self, scene: Scene, server: GazeboServer):
        self._scene = scene
        server.serve("get_joint_properties", srv.GetJointProperties, self._on_get)
        server.serve("set_joint_properties", srv.SetJointProperties, self._on_set)
        server.serve("set_model_configuration", srv.SetModelConfiguration, self._on_set_configuration)

    def _on_get(self, request):
        try:
            joint = self._scene.joints.get(self._scene.joints.full_name(request.joint_name))
        except UnknownEntityError:
            return srv.GetJointPropertiesResponse(
                success=False, status_message="GetJointProperties: joint not found"
            )
        response = srv.GetJointPropertiesResponse(
            type=KINDS[joint.kind], success=True, status_message="GetJointProperties: got properties"
        )
        if joint.kind != "fixed":
            state = self._scene.joints.state(joint.name)
            response.damping = [joint.damping]
            response.position, response.rate = [state.position], [state.speed]
        return response

    def _on_set(self, request):
        """Set damping and limits; other properties of ODE are ignored."""
        answer, config = srv.SetJointPropertiesResponse, request.ode_joint_config
        try:
            name = self._scene.joints.full_name(request.joint_name)
        except UnknownEntityError:
            return answer(False, "SetJointProperties: joint not found")
        joint = self._scene.joints.get(name)
        damping = config.damping[0] if config.damping else joint.damping
        lower = config.loStop[0] if config.loStop else joint.lower
        upper = config.hiStop[0] if config.hiStop else joint.upper
        if not (0.0 <= damping < np.inf and lower <= upper):
            return answer(False, "SetJointProperties: damping must not be negative, loStop not above hiStop")
        self._scene.joints.set_limits(name, lower, upper, damping)
        return answer(True, "SetJointProperties: properties set")

    def _on_set_configuration(self, request):
        answer, scene, model = srv.SetModelConfigurationResponse, self._scene, request.model_name
        if model not in scene.models.names():
            return answer(False, "SetModelConfiguration: model does not exist")
        if len(request.joint_names) != len(request.joint_positions):
            text = "SetModelConfiguration: joint name and position list have different lengths"
            return answer(False, text)
        if not np.isfinite(request.joint_positions).all():
            return answer(False, "SetModelConfiguration: a position is not finite")
        names = [name if "::" in name else f"{model}::{name}" for name in request.joint_names]
        known = scene.joints.movable_joints_of(model)
        positions = dict(zip(names, request.joint_positions))
        scene.joints.set_positions({name: positions[name] for name in names if name in known})
        return answer(True, "SetModelConfiguration: success")
