"""Observer of slam_gmapping: what it publishes before and after scans of a robot in a room."""

import math
import sys
from pathlib import Path

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from observed_node import ObservedNode, report
from tf2_msgs.msg import TFMessage

from planar import Pose2
from planar_ros.messages.conversion import grid_from_msg, pose2_of

sys.path.append(str(Path(__file__).parents[1] / "amcl_lite"))
from simple_robot import BEAMS, SimpleRobot  # noqa: E402

START = Pose2(1.2, 1.5, 0.0)
# A cell in the wall behind the robot, and one between the robot and it, from the robot's start.
IN_WALL, IN_FREE = (-1.0, 0.0), (-0.5, 0.0)


class Observer:
    """Publishes scans and collects what slam_gmapping publishes."""

    def __init__(self):
        self.node = ObservedNode("slam_gmapping")
        self.transforms, self.maps, self.values = [], [], {}
        self.robot = SimpleRobot(START, **self.node.given.get("frames", {}))
        rospy.Subscriber("/tf", TFMessage, self._on_tf)
        rospy.Subscriber("map", OccupancyGrid, self.maps.append)
        self.node.start()
        self.is_up = self.node.wait_until(lambda: "/dynamic_map" in self.node.services())
        rospy.sleep(1.5)
        if self.node.given.get("tilt"):
            self._tilt(self.node.given["tilt"])

    def _tilt(self, angle):
        """Tilt the mount of the laser."""
        broadcaster = self.robot.transforms._broadcaster
        send = self.robot.transforms.send

        def send_tilted(child_in_parent, parent, child, stamp):
            if child != self.robot.laser_frame:
                send(child_in_parent, parent, child, stamp)
                return
            message = TransformStamped()
            message.header.stamp, message.header.frame_id, message.child_frame_id = stamp, parent, child
            message.transform.rotation.y = math.sin(angle / 2.0)
            message.transform.rotation.w = math.cos(angle / 2.0)
            broadcaster.sendTransform(message)

        self.robot.transforms.send = send_tilted

    def _on_tf(self, message):
        if "slam_gmapping" in message._connection_header["callerid"]:
            now = rospy.Time.now()
            self.transforms += [(now, transform) for transform in message.transforms]

    def scans(self, count, value=None):
        """Publish scans, 0.2 s apart; ``value``: all ranges [m], as text if not finite."""
        ranges = None if value is None else np.full(BEAMS, float(value), np.float32)
        for _ in range(count):
            self.robot.sense(ranges=ranges)
            rospy.sleep(0.2)
        rospy.sleep(1.0)

    def move(self, x, y, yaw):
        """Move the robot."""
        self.robot.move(Pose2(x, y, yaw))

    def before(self):
        """Keep what is published before the first scan."""
        frames = [[each.header.frame_id, each.child_frame_id] for _, each in self.transforms]
        delays = [(each.header.stamp - now).to_sec() for now, each in self.transforms]
        poses = [pose2_of(each.transform.translation, each.transform.rotation) for _, each in self.transforms]
        self.values["tf_frames"] = frames[-1] if frames else None
        self.values["tf_is_identity"] = all(pose == Pose2() for pose in poses) if poses else None
        if delays:
            self.values["tf_delay"] = max(delays)  # that of the message with the least latency
            stamps = [each.header.stamp.to_sec() for _, each in self.transforms]
            self.values["tf_period"] = float(np.median(np.diff(stamps)))
        self.values["has_map_before"] = bool(self.maps)
        try:
            rospy.ServiceProxy("dynamic_map", GetMap)()
            self.values["dynamic_map_before"] = "answers"
        except rospy.ServiceException:
            self.values["dynamic_map_before"] = "fails"

    def note_map(self):
        """Keep the latched map."""
        try:
            message = rospy.wait_for_message("map", OccupancyGrid, 3.0)
        except rospy.ROSException:
            self.values["map"] = None
            return
        metadata = rospy.wait_for_message("map_metadata", MapMetaData, 3.0)
        served = rospy.ServiceProxy("dynamic_map", GetMap)().map
        grid = grid_from_msg(message)
        free_xy = grid.points_of(np.argwhere(grid.cells == 0))
        corner, opposite = (
            grid.origin,
            grid.origin @ Pose2(grid.cols * grid.resolution, grid.rows * grid.resolution),
        )
        self.values["map"] = {
            "frame": message.header.frame_id,
            "has_stamp": message.header.stamp > rospy.Time(0),
            "load_time": message.info.map_load_time.to_sec(),
            "resolution": round(message.info.resolution, 4),
            "values": sorted(set(grid.cells.ravel().tolist())),
            "occupied": int((grid.cells == 100).sum()),
            "free": int((grid.cells == 0).sum()),
            "origin_yaw": grid.origin.yaw,
            "contains": [corner.x, corner.y, opposite.x, opposite.y],
            "metadata_are_the_same": metadata == message.info,
            "served_is_the_same": list(served.data) == list(message.data),
            "in_wall": max(grid.value_at(IN_WALL[0] + 0.05 * step, IN_WALL[1]) for step in range(-6, 7)),
            "in_free": grid.value_at(*IN_FREE),
            "radius": round(float(np.abs(free_xy).max(initial=0.0)), 1),
        }

    def run(self):
        """Execute the steps and report."""
        for step, *arguments in self.node.given.get("steps", []):
            getattr(self, step)(*arguments)
        observed = {"values": self.values, "is_up": self.is_up, "maps": len(self.maps)}
        observed["publishes"], observed["subscribes"] = self.node.topics(), self.node.topics(published=False)
        observed["services"] = self.node.services()
        self.node.end()
        observed["log"], observed["exit_code"] = self.node.log, self.node.exit_code
        report(observed)


if __name__ == "__main__":
    Observer().run()
