"""Service type nav_msgs/LoadMap, which exists from nav_msgs 1.14 on (not in Debian 11)."""

import enum
from typing import Callable, Mapping

import rospy
from rospy.numpy_msg import numpy_msg

try:
    from nav_msgs.srv import LoadMap, LoadMapResponse
except ImportError:
    LoadMap = LoadMapArrays = None
else:

    class LoadMapArrays(LoadMap):  # type: ignore[no-redef]
        """nav_msgs/LoadMap whose map data is a numpy array."""

        _response_class = numpy_msg(LoadMapResponse)


class LoadMapResult(enum.IntEnum):
    """Result codes of nav_msgs/LoadMap."""

    SUCCESS = 0
    MAP_DOES_NOT_EXIST = 1
    INVALID_MAP_DATA = 2
    INVALID_MAP_METADATA = 3
    UNDEFINED_FAILURE = 255


def advertise_services(kind, handlers: Mapping[str, Callable]) -> None:
    """Advertise LoadMap services, or log that this system has no such type.

    Args:
        kind: ``LoadMap`` or ``LoadMapArrays``, which are None without the service type.
        handlers: Handler of each service name.
    """
    if kind is None:
        rospy.loginfo("nav_msgs of this system has no LoadMap; not advertising %s", ", ".join(handlers))
        return
    for name, handler in handlers.items():
        rospy.Service(name, kind, handler)
