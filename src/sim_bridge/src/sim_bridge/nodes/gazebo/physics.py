"""Time, gravity and the world as a whole."""

import gazebo_msgs.srv as srv
import numpy as np
from gazebo_msgs.msg import ODEPhysics
from geometry_msgs.msg import Vector3
from std_srvs.srv import Empty, EmptyResponse

from planar import PlanarError
from sim_bridge.errors import WorldError
from sim_bridge.nodes.gazebo.server import Server
from sim_bridge.nodes.time_control import TimeControl
from sim_bridge.scene import Scene


class PhysicsServices:
    def __init__(self, scene: Scene, time_control: TimeControl, server: Server):
        self._scene = scene
        self._time = time_control
        for name, do in (
            ("pause_physics", time_control.pause),
            ("unpause_physics", time_control.unpause),
            ("reset_world", time_control.reset_world),
            ("reset_simulation", time_control.reset_simulation),
        ):
            server.serve(name, Empty, lambda _request, do=do: (do(), EmptyResponse())[1])
        server.serve("get_world_properties", srv.GetWorldProperties, self._on_get_world)
        server.serve("get_physics_properties", srv.GetPhysicsProperties, self._on_get_physics)
        server.serve("set_physics_properties", srv.SetPhysicsProperties, self._on_set_physics)

    def _on_get_world(self, _request):
        return srv.GetWorldPropertiesResponse(
            sim_time=self._scene.stamp,
            model_names=self._scene.model_names(),
            rendering_enabled=True,
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
