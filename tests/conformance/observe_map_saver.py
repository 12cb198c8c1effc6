"""Observer of map_saver: the files it writes of a map on a topic."""

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid
from observed_node import ObservedNode, report


def main():
    """Publish a map, run map_saver and report."""
    node = ObservedNode("map_saver")
    message = OccupancyGrid()
    message.info.resolution, message.info.width = 0.5, node.given.get("width", 4)
    message.data = node.given.get("data", [0, 100, -1, 50])
    message.info.height = len(message.data) // message.info.width
    message.info.origin.position.x, message.info.origin.position.y = -1.0, 2.0
    q = message.info.origin.orientation
    q.x, q.y, q.z, q.w = node.given.get("quaternion", [0.0, 0.0, 0.0, 1.0])
    publisher = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
    publisher.publish(message)
    node.start(*node.given.get("arguments", []))
    node.wait_until(lambda: node.exit_code is not None)
    observed = {
        "exit_code": node.exit_code,
        "log": node.log,
        "files": sorted(path.name for path in node.folder.iterdir()),
    }
    for pgm in node.folder.glob("*.pgm"):
        data = pgm.read_bytes()
        observed["pixels"] = np.frombuffer(data[-len(message.data) :], np.uint8).tolist()
        observed["magic"] = data[:2].decode()
    for description in node.folder.glob("*.yaml"):
        observed["yaml"] = description.read_text(encoding="utf-8")
    node.end()
    report(observed)


if __name__ == "__main__":
    main()
