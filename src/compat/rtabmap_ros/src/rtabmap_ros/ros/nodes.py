"""The nodes: slam_lite, started as rtabmap is, and what is said instead of rtabmapviz."""

import os
import sys

import rosgraph
import rospy

from rtabmap_ros.arguments import slam_lite_arguments

RTABMAPVIZ_NOTICE = (
    "rtabmap is not here: slam_lite makes a 2D map of the laser's scans in its place, without pictures, "
    "points or a database"
)
NO_VIZ = "rtabmapviz is not here: rviz shows the map, and the cockpit does in the browser"


def rtabmap() -> None:
    """Becomes slam_lite."""
    from slam_lite.ros.node import main as make_map

    print(RTABMAPVIZ_NOTICE, file=sys.stderr)
    sys.argv[1:] = slam_lite_arguments(sys.argv[1:], _parameter)
    rospy.names.reload_mappings(sys.argv)  # rospy has read them when it was imported
    make_map()


def rtabmapviz() -> None:
    """Says that there is nothing to see here."""
    print(NO_VIZ, file=sys.stderr)


def _parameter(name: str, default: str) -> str:
    """Read before the node is there: slam_lite begins it."""
    names = [word.split(":=", 1)[1] for word in sys.argv if word.startswith("__name:=")]
    parts = [os.environ.get("ROS_NAMESPACE", "").strip("/"), *(names or ["rtabmap"])]
    node = "/" + "/".join(filter(None, parts))
    try:
        return str(rosgraph.Master(node).getParam(f"{node}/{name}"))
    except rosgraph.MasterException:
        return default
