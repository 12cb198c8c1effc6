"""dynamic_reconfigure servers of move_base, its costmaps, their layers and its planners."""

import threading
from functools import partial
from typing import Any, Callable, Dict

import rospy
import yaml
from geometry_msgs.msg import Polygon

from move_base_lite.config import NavigatorSettings
from move_base_lite.parameters import settings_from_parameters
from move_base_lite.parameters.planners import REGISTRIES
from move_base_lite.parameters.reconfigure import reconfigure_servers, with_changes
from planar import SettingsError
from planar_ros.node.parameters import ReconfigureServer


class ReconfigureServers:
    """Serves the parameters and applies changes.

    Args:
        parameters: Parameters at start-up, a nested dictionary.
        apply: Called with the new settings after a change.
    """

    def __init__(self, parameters: Dict[str, Any], apply: Callable[[NavigatorSettings], None]):
        self._parameters = parameters
        self._apply = apply
        self._lock, self._serving = threading.RLock(), threading.Lock()
        self._servers: Dict[str, ReconfigureServer] = {}
        for costmap in ("global_costmap", "local_costmap"):
            self._subscribe_footprint(costmap)

    def serve(self) -> None:
        """Start the servers that do not exist yet."""
        with self._serving:
            for namespace, tunables in reconfigure_servers(self._parameters).items():
                if namespace not in self._servers:
                    self._servers[namespace] = ReconfigureServer(
                        [tunable for tunable, _ in tunables],
                        {tunable.name: value for tunable, value in tunables},
                        partial(self._change, namespace),
                        namespace,
                    )

    def _change(self, namespace: str, requested: Dict[str, Any]) -> Dict[str, Any]:
        """Apply requested values, all or none; return the values in effect."""
        where = rospy.get_name() + "/"
        with self._lock:
            try:
                for key, registry in REGISTRIES.items():
                    if key in requested and registry.find(requested[key]) is None:
                        known = ", ".join(registry.names)
                        raise SettingsError(f"{where}{key} must be one of {known}, got {requested[key]}")
                parameters = with_changes(self._parameters, namespace, requested)
                settings, _ = settings_from_parameters(parameters, where, is_lenient=True)
            except SettingsError as error:
                rospy.logerr("%s; nothing is changed", error)
                return {
                    tunable.name: value for tunable, value in reconfigure_servers(self._parameters)[namespace]
                }
            self._parameters = parameters
            self._apply(settings)
        if set(REGISTRIES) & set(requested):
            threading.Thread(target=self.serve, daemon=True).start()
        return requested

    def _subscribe_footprint(self, costmap: str) -> None:
        """Subscribe to footprints (Polygon) on the topic that publishes the present one (PolygonStamped)."""
        topic = self._parameters.get(costmap, {}).get("footprint_topic", "footprint")
        rospy.Subscriber(f"~{costmap}/{topic}", rospy.AnyMsg, self._on_footprint, costmap, queue_size=1)

    def _on_footprint(self, message, costmap: str) -> None:
        if message._connection_header["type"] != Polygon._type:
            return
        polygon = Polygon().deserialize(message._buff)
        corners = yaml.safe_dump([[point.x, point.y] for point in polygon.points], default_flow_style=True)
        self._change(costmap, {"footprint": corners.strip()})
