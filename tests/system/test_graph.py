#!/usr/bin/env python3
"""The live graph has the names that existing tools and projects look for, and one tree of frames."""

import time
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
import tf2_ros
import yaml

WALL_DEADLINE = 60.0
SETTLING_SECONDS = 3.0
NODES = {"/sim_bridge", "/robot_state_publisher", "/map_server", "/amcl", "/move_base"}
NODES |= {"/pick_objects", "/add_markers"}
TOPICS = {
    "/clock": "rosgraph_msgs/Clock",
    "/odom": "nav_msgs/Odometry",
    "/scan": "sensor_msgs/LaserScan",
    "/joint_states": "sensor_msgs/JointState",
    "/base_pose_ground_truth": "nav_msgs/Odometry",
    "/map": "nav_msgs/OccupancyGrid",
    "/map_metadata": "nav_msgs/MapMetaData",
    "/amcl_pose": "geometry_msgs/PoseWithCovarianceStamped",
    "/particlecloud": "geometry_msgs/PoseArray",
    "/move_base/goal": "move_base_msgs/MoveBaseActionGoal",
    "/move_base/status": "actionlib_msgs/GoalStatusArray",
    "/move_base/current_goal": "geometry_msgs/PoseStamped",
    "/move_base/global_costmap/costmap": "nav_msgs/OccupancyGrid",
    "/move_base/local_costmap/costmap": "nav_msgs/OccupancyGrid",
    "/move_base/NavfnROS/plan": "nav_msgs/Path",
    "/cmd_vel": "geometry_msgs/Twist",
    "/visualization_marker": "visualization_msgs/Marker",
}
SERVICES = {"/static_map", "/global_localization", "/request_nomotion_update", "/set_map"}
SERVICES |= {"/move_base/make_plan", "/move_base/clear_costmaps"}
NAMES_PAGE = Path(__file__).resolve().parents[2] / "docs/reference/topics.md"
# Of every node, and of dynamic_reconfigure and actions; and what tests and tools bring along.
UNSPOKEN = ("get_loggers", "set_logger_level", "waiting_for")
UNSPOKEN += ("set_parameters", "parameter_descriptions", "parameter_updates")
UNSPOKEN += (
    "goal",
    "cancel",
    "status",
    "feedback",
    "result",
    "rosout",
    "rosout_agg",
    "costmap_updates",
    "tf_static",
)
CHAIN = ["map", "odom", "base_footprint", "base_link"]


class GraphTest(unittest.TestCase):
    def setUp(self):
        self.master = rosgraph.Master(rospy.get_name())

    def test_the_nodes_have_the_official_names(self):
        self._wait_for(NODES, self._nodes)

    def test_the_topics_have_the_official_names_and_types(self):
        self._wait_for(set(TOPICS.items()), lambda: {tuple(pair) for pair in self.master.getTopicTypes()})

    def test_the_services_have_the_official_names(self):
        self._wait_for(SERVICES, lambda: {name for name, _ in self.master.getSystemState()[2]})

    def test_docs_names_lists_every_topic_and_service(self):
        self._wait_for(NODES, self._nodes)
        page = NAMES_PAGE.read_text(encoding="utf-8")
        publishers, _, services = self._settled_graph()
        mine = {rospy.get_name()}
        names = {name for name, nodes in [*publishers, *services] if set(nodes) - mine}
        unknown = {name for name in names if f"`{name}`" not in page and not name.endswith(UNSPOKEN)}
        self.assertEqual(unknown, set(), "not in docs/reference/topics.md")

    def test_there_is_one_tree_of_frames_from_map_to_base_link_and_laser(self):
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)
        self._wait_for({*CHAIN[1:], "laser"}, lambda: set(_parents(buffer)))
        parents = _parents(buffer)
        self.assertEqual([parents.get(frame) for frame in CHAIN[1:]], CHAIN[:-1])
        roots = {parent for parent in parents.values() if parent not in parents}
        self.assertEqual(roots, {"map"})

    def _settled_graph(self):
        """Publishers, subscribers and services when nothing has been added for a while."""
        deadline = time.monotonic() + WALL_DEADLINE
        graph, before = self.master.getSystemState(), None
        while graph != before:
            self.assertLess(time.monotonic(), deadline, "the graph keeps changing")
            time.sleep(SETTLING_SECONDS)
            graph, before = self.master.getSystemState(), graph
        return graph

    def _nodes(self):
        return {name for part in self.master.getSystemState() for _, names in part for name in names}

    def _wait_for(self, expected, present):
        deadline = time.monotonic() + WALL_DEADLINE
        while expected - present():
            self.assertLess(time.monotonic(), deadline, f"missing: {sorted(expected - present())}")
            time.sleep(0.1)


def _parents(buffer):
    frames = yaml.safe_load(buffer.all_frames_as_yaml()) or {}
    return {frame: fields["parent"] for frame, fields in frames.items()}


if __name__ == "__main__":
    rospy.init_node("test_graph")
    rostest.rosrun("home_service_tests", "graph", GraphTest)
