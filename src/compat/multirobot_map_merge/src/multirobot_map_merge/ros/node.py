"""The node ``map_merge``, with the parameters of multirobot_map_merge, for robots with known poses."""

import threading
from typing import Dict, List, Tuple

import rosgraph
import rospy
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg

from multirobot_map_merge.map_merging import merge_maps
from planar import OccupancyGrid, PlanarError, Pose2
from planar_ros.messages.conversion import frame_name, grid_from_msg, grid_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.node.runner import run


class MapMerge:
    """Finds the maps of the robots, and publishes the merged map."""

    def __init__(self) -> None:
        self._map_topic = rospy.get_param("~robot_map_topic", "map")
        self._namespace = rospy.get_param("~robot_namespace", "")
        self._frame = frame_name(rospy.get_param("~world_frame", "world"))
        self._topic = rospy.resolve_name(rospy.get_param("~merged_map_topic", "map"))
        if not rospy.get_param("~known_init_poses", True):
            rospy.logwarn(
                "~known_init_poses is false, but map_merge does not estimate poses: provide them by tf or "
                "by the parameters init_pose_x, init_pose_y and init_pose_yaw"
            )
        self._transforms = Transforms()
        self._lock = threading.Lock()
        self._maps: Dict[str, Tuple[str, OccupancyGrid]] = {}
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        self._publisher = rospy.Publisher(self._topic, OccupancyGridMsg, queue_size=1, latch=True)
        self._discover()
        rospy.Timer(_period("~discovery_rate", 0.05), self._discover, reset=True)
        rospy.Timer(_period("~merging_rate", 4.0), self._merge, reset=True)

    def _discover(self, _event=None) -> None:
        for topic, kind in rosgraph.Master(rospy.get_name()).getTopicTypes():
            robot, _, name = topic.rpartition("/")
            is_map = kind == OccupancyGridMsg._type and name == self._map_topic and topic != self._topic
            if is_map and self._namespace in robot and topic not in self._subscribers:
                rospy.loginfo("adding the map of %s", robot or "/")
                callback = lambda message, robot=robot: self._on_map(robot, message)  # noqa: E731
                self._subscribers[topic] = rospy.Subscriber(topic, OccupancyGridMsg, callback, queue_size=1)

    def _on_map(self, robot: str, message: OccupancyGridMsg) -> None:
        with self._lock:
            self._maps[robot] = (frame_name(message.header.frame_id), grid_from_msg(message))

    def _merge(self, _event=None) -> None:
        with self._lock:
            maps = dict(self._maps)
        if not maps:
            return
        placed: List[Tuple[Pose2, OccupancyGrid]] = [
            (self._map_frame_in_world(robot, frame), grid) for robot, (frame, grid) in sorted(maps.items())
        ]
        try:
            grid = merge_maps(placed)
        except PlanarError as error:
            rospy.logwarn_throttle(10.0, "maps not merged: %s", error)
            return
        self._publisher.publish(grid_to_msg(grid, rospy.Time.now(), self._frame))

    def _map_frame_in_world(self, robot: str, frame: str) -> Pose2:
        """Pose of a map's frame in the world: from tf, else from the robot's parameters."""
        frame_in_world = self._transforms.lookup(self._frame, frame)
        if frame_in_world is not None:
            return frame_in_world
        names = (f"{robot}/map_merge/init_pose_{name}" for name in ("x", "y", "yaw"))
        return Pose2(*(float(rospy.get_param(name, 0.0)) for name in names))


def _period(parameter: str, default: float) -> rospy.Duration:
    rate = float(rospy.get_param(parameter, default))
    if not rate > 0.0:
        raise PlanarError(f"{parameter} must be positive, got {rate:g}")
    return rospy.Duration(1.0 / rate)


def main() -> None:
    run("map_merge", MapMerge)
