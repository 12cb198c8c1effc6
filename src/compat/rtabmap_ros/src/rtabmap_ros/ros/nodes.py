"""The nodes rtabmap, backed by slam_lite, and rtabmapviz, which prints a notice."""

import os
import sys

import rosgraph

from rospy_transport.node import reload_remappings
from rtabmap_ros.arguments import slam_lite_arguments

RTABMAPVIZ_NOTICE = (
    "rtabmap is not available: slam_lite makes a 2D map of the laser scans instead, without images, point "
    "clouds and database"
)
NO_VIZ = "rtabmapviz is not available: the map is shown by rviz, and by the cockpit in the browser"


def rtabmap() -> None:
    """Run slam_lite with rtabmap's arguments."""
    from slam_lite.ros.node import main as make_map

    print(RTABMAPVIZ_NOTICE, file=sys.stderr)
    sys.argv[1:] = slam_lite_arguments(sys.argv[1:], _parameter)
    reload_remappings()
    make_map()


def rtabmapviz() -> None:
    """Print a notice."""
    print(NO_VIZ, file=sys.stderr)


def _parameter(name: str, default: str) -> str:
    """Read a private parameter before the node is initialized, which slam_lite does."""
    names = [word.split(":=", 1)[1] for word in sys.argv if word.startswith("__name:=")]
    parts = [os.environ.get("ROS_NAMESPACE", "").strip("/"), *(names or ["rtabmap"])]
    node = "/" + "/".join(filter(None, parts))
    try:
        return str(rosgraph.Master(node).getParam(f"{node}/{name}"))
    except rosgraph.MasterException:
        return default
