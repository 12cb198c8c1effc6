"""Services that get, set and delete lights; rendering does not use lights."""

from dataclasses import replace

import gazebo_msgs.srv as srv
from std_msgs.msg import ColorRGBA

from sim_bridge.ros.gazebo.server import GazeboServer
from sim_bridge.scene import Scene


class LightServices:
    def __init__(self, scene: Scene, server: GazeboServer):
        self._lights = scene.lights
        server.serve("get_light_properties", srv.GetLightProperties, self._on_get)
        server.serve("set_light_properties", srv.SetLightProperties, self._on_set)
        server.serve("delete_light", srv.DeleteLight, self._on_delete)

    def _on_get(self, request):
        if request.light_name not in self._lights:
            text = f"getLightProperties: Requested light {request.light_name} not found!"
            return srv.GetLightPropertiesResponse(success=False, status_message=text)
        light = self._lights[request.light_name]
        constant, linear, quadratic = light.attenuation
        return srv.GetLightPropertiesResponse(
            ColorRGBA(*light.diffuse), constant, linear, quadratic, True, ""
        )

    def _on_set(self, request):
        if request.light_name not in self._lights:
            text = f"setLightProperties: Requested light {request.light_name} not found!"
            return srv.SetLightPropertiesResponse(False, text)
        diffuse = request.diffuse
        self._lights[request.light_name] = replace(
            self._lights[request.light_name],
            diffuse=(diffuse.r, diffuse.g, diffuse.b, diffuse.a),
            attenuation=(
                request.attenuation_constant,
                request.attenuation_linear,
                request.attenuation_quadratic,
            ),
        )
        return srv.SetLightPropertiesResponse(True, "")

    def _on_delete(self, request):
        name = request.light_name
        if self._lights.pop(name, None) is None:
            return srv.DeleteLightResponse(False, f"DeleteLight: Requested light {name} not found!")
        return srv.DeleteLightResponse(True, f"DeleteLight: {name} successfully deleted")
