"""Services that get and set properties of models and links."""

import gazebo_msgs.srv as srv
import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion

from sim_bridge.errors import UnknownEntityError, WorldError
from sim_bridge.geometry.pose3 import position
from sim_bridge.ros.gazebo.server import SCOPE_HINT, GazeboServer
from sim_bridge.ros.messages import vector_from_msg
from sim_bridge.scene import Scene

# Relative difference of moments of inertia, and distance of centres of mass [m], that count as equal.
NEGLIGIBLE = 1e-6


class PropertyServices:
    def __init__(self, scene: Scene, server: GazeboServer):
        self._scene = scene
        server.serve("get_model_properties", srv.GetModelProperties, self._on_get_model)
        server.serve("get_link_properties", srv.GetLinkProperties, self._on_get_link)
        server.serve("set_link_properties", srv.SetLinkProperties, self._on_set_link)

    def _on_get_model(self, request):
        scene, model = self._scene, request.model_name
        if model not in scene.models.names():
            return srv.GetModelPropertiesResponse(
                success=False, status_message="GetModelProperties: model does not exist"
            )
        links = [_inside(model, link) for link in scene.models.links_of(model)]
        return srv.GetModelPropertiesResponse(
            canonical_body_name=links[0],
            body_names=[link for link in links if "::" not in link],
            geom_names=scene.models.collisions_of(model),
            joint_names=[_inside(model, joint) for joint in scene.joints.joints_of(model)],
            child_model_names=sorted({link.split("::", 1)[0] for link in links if "::" in link}),
            is_static=scene.models.is_static(model),
            success=True,
            status_message="GetModelProperties: got properties",
        )

    def _on_get_link(self, request):
        try:
            mass = self._scene.models.mass_properties(self._scene.models.full_link_name(request.link_name))
        except UnknownEntityError:
            return srv.GetLinkPropertiesResponse(
                success=False, status_message=f"GetLinkProperties: link not found, {SCOPE_HINT}"
            )
        axes = mass.centre[:3, :3]
        inertia = axes @ np.diag(mass.moments) @ axes.T
        return srv.GetLinkPropertiesResponse(
            com=Pose(Point(*position(mass.centre)), Quaternion(w=1.0)),
            gravity_mode=mass.has_gravity,
            mass=mass.mass,
            ixx=inertia[0, 0],
            ixy=inertia[0, 1],
            ixz=inertia[0, 2],
            iyy=inertia[1, 1],
            iyz=inertia[1, 2],
            izz=inertia[2, 2],
            success=True,
            status_message="GetLinkProperties: got properties",
        )

    def _on_set_link(self, request):
        """Set mass, principal moments and gravity; axes and centre of mass must stay."""
        answer = srv.SetLinkPropertiesResponse
        try:
            link = self._scene.models.full_link_name(request.link_name)
            kept = self._scene.models.mass_properties(link)
        except UnknownEntityError:
            return answer(False, f"SetLinkProperties: link not found, {SCOPE_HINT}")
        inertia = np.array(
            [
                [request.ixx, request.ixy, request.ixz],
                [request.ixy, request.iyy, request.iyz],
                [request.ixz, request.iyz, request.izz],
            ]
        )
        axes = kept.centre[:3, :3]
        about_axes = axes.T @ inertia @ axes
        moments = np.diag(about_axes)
        if np.abs(about_axes - np.diag(moments)).max() > NEGLIGIBLE * moments.max():
            return answer(False, "SetLinkProperties: the principal axes of inertia cannot be turned")
        if np.abs(vector_from_msg(request.com.position) - kept.centre[:3, 3]).max() > NEGLIGIBLE:
            return answer(False, "SetLinkProperties: the centre of mass cannot be moved")
        try:
            self._scene.models.set_mass(link, request.mass, moments.tolist(), request.gravity_mode)
        except WorldError as error:
            return answer(False, f"SetLinkProperties: {error}")
        return answer(True, "SetLinkProperties: properties set")


def _inside(model: str, name: str) -> str:
    """Return a full name without its model."""
    return name[len(model) + 2 :]
