"""The node ``map_server``, with the interface of map_server 1.17.

    map_server MAP.yaml
    map_server IMAGE RESOLUTION      (deprecated)

If the map cannot be loaded, it exits with code 2 (the official one: 255) and an error naming file and key.
"""

import numpy as np
import rospkg
import rospy
from nav_msgs.msg import MapMetaData

from map_lite.config import ServerSettings
from map_lite.map_source import parse_arguments, resolve_map_url
from planar import MapFileError, OccupancyGrid, Pose2, load_map
from planar.maps.map_file import MapDescriptionError, MapImageError, MapMissingError, cells_from_image
from planar_ros.calls.load_map import LoadMapArrays, LoadMapResult, advertise_services
from planar_ros.messages.conversion import GetMapArrays, OccupancyGridArrays, grid_to_msg
from planar_ros.node.parameters import read_settings
from planar_ros.node.runner import run

# Parameters that apply to an image without description only, and why not else.
OF_AN_IMAGE = "negate", "occupied_thresh", "free_thresh"
IN_THE_MAP = "the YAML file of the map has it"
RESULTS = {
    MapMissingError: LoadMapResult.MAP_DOES_NOT_EXIST,
    MapImageError: LoadMapResult.INVALID_MAP_DATA,
    MapDescriptionError: LoadMapResult.INVALID_MAP_METADATA,
}


class MapServerNode:
    """Publishes one map, latched, and serves it; the service change_map replaces it."""

    def __init__(self, arguments):
        """Load the map, publish it and advertise the services.

        Args:
            arguments: Result of ``parse_arguments``.

        Raises:
            MapFileError: The map cannot be loaded.
        """
        has_description = arguments.resolution is None
        self._settings = read_settings(
            ServerSettings,
            without_effect=lambda settings: dict.fromkeys(OF_AN_IMAGE, IN_THE_MAP) if has_description else {},
        )
        grid = self._load(arguments)
        self._map_publisher = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self._metadata_publisher = rospy.Publisher("map_metadata", MapMetaData, queue_size=1, latch=True)
        self._publish(grid)
        rospy.Service("static_map", GetMapArrays, lambda request: {"map": self._map})
        advertise_services(LoadMapArrays, {"change_map": self._on_change_map})

    def _load(self, arguments) -> OccupancyGrid:
        path = resolve_map_url(arguments.map, _package_folder)
        if arguments.resolution is None:
            return load_map(path)
        rospy.logwarn("an image and a resolution instead of a map are deprecated: write a YAML file")
        settings = self._settings
        cells = cells_from_image(
            path, bool(settings.negate), settings.occupied_thresh, settings.free_thresh, "trinary"
        )
        return OccupancyGrid(cells, arguments.resolution, Pose2())

    def _publish(self, grid: OccupancyGrid):
        self._map = grid_to_msg(grid, rospy.Time.now(), self._settings.frame_id)
        self._map.info.map_load_time = self._map.header.stamp
        self._map_publisher.publish(self._map)
        self._metadata_publisher.publish(self._map.info)
        rospy.loginfo("Read a %d X %d map @ %.3f m/cell", grid.cols, grid.rows, grid.resolution)

    def _on_change_map(self, request):
        try:
            self._publish(load_map(resolve_map_url(request.map_url, _package_folder)))
        except MapFileError as error:
            rospy.logerr("%s", error)
            empty = OccupancyGridArrays(data=np.zeros(0, dtype=np.int8))
            return {"map": empty, "result": RESULTS.get(type(error), LoadMapResult.UNDEFINED_FAILURE)}
        return {"map": self._map, "result": LoadMapResult.SUCCESS}


def _package_folder(package: str) -> str:
    try:
        return rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound as error:
        raise LookupError(package) from error


def main():
    """Run the node ``map_server``."""
    arguments = parse_arguments(rospy.myargv()[1:])
    run("map_server", lambda: MapServerNode(arguments))
