"""Services for time, gravity and the world as a whole."""

from copy import deepcopy
from typing import Any, Dict

import gazebo_msgs.srv as srv
import numpy as np
import rospy
from gazebo_msgs.msg import ODEPhysics
from geometry_msgs.msg import Vector3
from std_srvs.srv import Empty, EmptyResponse

from planar import PlanarError
from planar.config.parameters import DynamicParameter
from planar_ros.node.parameters import ReconfigureServer
from sim_bridge.config import MAX_PHYSICS_RATE
from sim_bridge.errors import WorldError
from sim_bridge.ros.gazebo.server import NAMESPACE, GazeboServer
from sim_bridge.ros.timing.time_control import TimeControl
from sim_bridge.scene import Scene

# Gazebo's defaults of ODE's settings, which have no effect here.
ODE = ODEPhysics(
    sor_pgs_iters=50,
    sor_pgs_w=1.3,
    contact_surface_layer=0.001,
    contact_max_correcting_vel=100.0,
    erp=0.2,
    max_contacts=20,
)
# Dynamic parameters (Physics.cfg of gazebo_ros).
TUNABLES = (
    DynamicParameter("time_step", 0.005, "s of simulated time in a step of physics", 0.0, 10.0),
    DynamicParameter(
        "max_update_rate", 200.0, "steps a second of real time; 0: as fast as possible", 0.0, 1000.0
    ),
    *(
        DynamicParameter(f"gravity_{axis}", 0.0, f"gravity along {axis}, m/s^2", -100.0, 100.0)
        for axis in "xyz"
    ),
    *(
        DynamicParameter(name, getattr(ODE, name), "setting of ODE, without effect")
        for name in ODEPhysics.__slots__
    ),
)


class PhysicsServices:
    def __init__(self, scene: Scene, time_control: TimeControl, server: GazeboServer):
        self._scene = scene
        self._time = time_control
        self._ode = deepcopy(ODE)
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
        self._server = server
        ReconfigureServer(TUNABLES, self._values(), self._on_reconfigure, NAMESPACE)

    def _on_get_world(self, _request):
        return srv.GetWorldPropertiesResponse(
            sim_time=self._scene.stamp,
            model_names=self._scene.models.names(),
            rendering_enabled=True,
            success=True,
            status_message="GetWorldProperties: got properties",
        )

    def _on_get_physics(self, _request):
        values = self._values()
        return srv.GetPhysicsPropertiesResponse(
            time_step=values["time_step"],
            pause=self._time.is_paused,
            max_update_rate=values["max_update_rate"],
            gravity=Vector3(*(values[f"gravity_{axis}"] for axis in "xyz")),
            ode_config=self._ode,
            success=True,
            status_message="GetPhysicsProperties: got properties",
        )

    def _on_set_physics(self, request):
        try:
            self._set(request.time_step, request.max_update_rate, request.gravity)
            self._set_ode({name: getattr(request.ode_config, name) for name in ODEPhysics.__slots__})
        except PlanarError as error:
            return srv.SetPhysicsPropertiesResponse(False, f"SetPhysicsProperties: {error}")
        return srv.SetPhysicsPropertiesResponse(True, "physics engine updated")

    def _on_reconfigure(self, values: Dict[str, Any]) -> Dict[str, Any]:
        """Set new values; keep the old ones if they are invalid."""
        gravity = Vector3(*(values[f"gravity_{axis}"] for axis in "xyz"))

        def change():
            try:
                self._set(values["time_step"], values["max_update_rate"], gravity)
                self._set_ode({name: values[name] for name in ODEPhysics.__slots__})
            except PlanarError as error:
                rospy.logerr("%sset_parameters: %s", NAMESPACE, error)
            return self._values()

        return self._server.between_steps(change)

    def _set(self, time_step: float, max_update_rate: float, gravity: Vector3) -> None:
        """Set rates and gravity; max_update_rate 0 is as fast as possible. Raises PlanarError."""
        if gravity.x or gravity.y or not np.isfinite(gravity.z):
            raise WorldError("gravity must point along the z axis")
        if not (time_step * MAX_PHYSICS_RATE >= 1.0 and 0.0 <= max_update_rate < np.inf):
            least = 1.0 / MAX_PHYSICS_RATE
            raise WorldError(f"time_step must be at least {least:g}, max_update_rate not negative")
        self._scene.set_physics_rate(round(1.0 / time_step))
        self._scene.set_gravity(-gravity.z)
        self._time.set_speed(max_update_rate * time_step)

    def _set_ode(self, values: Dict[str, Any]) -> None:
        """Keep settings of ODE for ``get_physics_properties``, and log those that change."""
        for name, value in values.items():
            if value != getattr(self._ode, name):
                rospy.logwarn("%sset_physics_properties: %s has no effect: there is no ODE", NAMESPACE, name)
                setattr(self._ode, name, value)

    def _values(self) -> Dict[str, Any]:
        rate = self._scene.settings.physics_rate
        return {
            "time_step": 1.0 / rate,
            "max_update_rate": rate * self._time.speed,
            "gravity_x": 0.0,
            "gravity_y": 0.0,
            "gravity_z": -self._scene.gravity,
            **{name: getattr(self._ode, name) for name in ODEPhysics.__slots__},
        }
