"""The services save_map, save_state and load_state."""

from typing import Callable, Dict

import rospy

from planar import PlanarError, save_map
from planar_ros.calls.load_map import LoadMap, LoadMapResult, advertise_services
from slam_lite.ros.map_publisher import MapPublisher
from slam_lite.ros.thread_safe_mapper import ThreadSafeMapper
from slam_lite.state import save_state


class FileServices:
    """Services that save the map, and save and load the state."""

    def __init__(self, mapper: ThreadSafeMapper, maps: MapPublisher):
        """Advertise the services.

        Args:
            mapper: Mapper whose state is saved and loaded.
            maps: Renders the map to save.
        """
        self._mapper = mapper
        self._maps = maps
        handlers = {
            "~save_map": self._on_save_map,
            "~save_state": self._on_save_state,
            "~load_state": self._on_load_state,
        }
        advertise_services(LoadMap, handlers)

    def _on_save_map(self, request):
        grid = self._maps.grid()
        if grid is None:
            raise rospy.ServiceException("there is no map yet: no scan has been received")
        return _answer(save_map, grid, _stem(request.map_url))

    def _on_save_state(self, request):
        return _answer(save_state, self._mapper.state(), request.map_url)

    def _on_load_state(self, request):
        return _answer(self._mapper.load, request.map_url)


def _answer(act: Callable[..., object], *arguments) -> Dict[str, LoadMapResult]:
    try:
        act(*arguments)
    except PlanarError as error:
        rospy.logerr("%s", error)
        raise rospy.ServiceException(str(error)) from None
    return {"result": LoadMapResult.SUCCESS}


def _stem(path: str) -> str:
    return path[: -len(".yaml")] if path.endswith(".yaml") else path
