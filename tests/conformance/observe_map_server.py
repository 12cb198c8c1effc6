"""Observer of map_server: its topics, services and messages."""

import rospy
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from observed_node import ObservedNode, report

from planar_ros.calls.load_map import LoadMap
from planar_ros.messages.conversion import yaw_of

SECONDS = 10.0


def described(grid):
    """What is of interest of an OccupancyGrid."""
    info = grid.info
    return {
        "frame": grid.header.frame_id,
        "has_stamp": grid.header.stamp > rospy.Time(0),
        "has_load_time": info.map_load_time > rospy.Time(0),
        "size": [info.width, info.height],
        "resolution": round(info.resolution, 6),
        "origin": [
            round(value, 6)
            for value in (info.origin.position.x, info.origin.position.y, yaw_of(info.origin.orientation))
        ],
        "data": list(grid.data),
    }


def main():
    """Start map_server with files of the input and report."""
    node = ObservedNode("map_server")
    for name, content in node.given.get("files", {}).items():
        (node.folder / name).write_bytes(bytes(content))
    node.start(*node.given["arguments"])
    observed = {}
    if node.wait_until(lambda: "/static_map" in node.services() and "/map" in node.topics()):
        rospy.sleep(1.0)  # so that the messages below are latched ones
    if node.exit_code is None:
        observed["map"] = described(rospy.wait_for_message("map", OccupancyGrid, SECONDS))
        metadata = rospy.wait_for_message("map_metadata", MapMetaData, SECONDS)
        observed["metadata"] = [metadata.width, metadata.height, round(metadata.resolution, 6)]
        observed["static_map"] = described(rospy.ServiceProxy("static_map", GetMap)().map)
        observed["topics"], observed["services"] = node.topics(), node.services()
        observed["changes"] = []
        for url in node.given.get("changes", []):
            response = rospy.ServiceProxy("change_map", LoadMap)(url.replace("FOLDER", str(node.folder)))
            now = rospy.ServiceProxy("static_map", GetMap)().map
            observed["changes"].append([response.result == 0, list(response.map.data), list(now.data)])
    observed["exit_code"] = node.exit_code
    node.end()
    observed["log"] = node.log
    report(observed)


if __name__ == "__main__":
    main()
