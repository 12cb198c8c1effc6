"""The service type nav_msgs/LoadMap, which nav_msgs has from 1.14 on: Debian 11's has none."""

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
        """nav_msgs/LoadMap whose map comes and goes as a numpy array."""

        _response_class = numpy_msg(LoadMapResponse)


class LoadMapResult(enum.IntEnum):
    """The codes of its answer."""

    SUCCESS = 0
    MAP_DOES_NOT_EXIST = 1
    INVALID_MAP_DATA = 2
    INVALID_MAP_METADATA = 3
    UNDEFINED_FAILURE = 255


def advertise_services(kind, handlers: Mapping[str, Callable]) -> None:
    """Serves each name with ``kind``, one of the types above; where there is none, says so once."""
    if kind is None:
        rospy.loginfo("nav_msgs of this system has no LoadMap, so there is no %s", ", ".join(handlers))
        return
    for name, handler in handlers.items():
        rospy.Service(name, kind, handler)
