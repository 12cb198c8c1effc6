#!/usr/bin/env python3
"""Costmap layers by entry over ROS: a virtual wall in the local costmap, and parameters without effect."""

import subprocess

import numpy as np
import rospy
import rostest
from dynamic_reconfigure.client import Client
from fake_robot import FakeRobot
from map_msgs.msg import OccupancyGridUpdate
from move_base_client import MessageRecorder, MoveBaseTestCase
from nav_msgs.msg import OccupancyGrid
from roslib.packages import find_node

from planar import OccupancyGrid as Grid
from planar import Pose2
from planar_ros.messages.conversion import grid_to_msg

# Cells of 0.1 m at (0, 0) in the map: a virtual wall beside the robot at (1, 2), and a gap that is closed.
WALL, GAP, IN_FRONT = (1.05, 2.95), (1.35, 2.95), (2.025, 2.025)
LETHAL = 100
UNUSED = ("local_costmap/map_type", "DWAPlannerROS/scaling_speed")


def virtual_walls():
    cells = np.zeros((40, 40), np.int8)
    cells[29, 5:13] = LETHAL
    return Grid(cells, 0.1, Pose2())


class TestCostmapLayers(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        cls.walls = rospy.Publisher("virtual_walls", OccupancyGrid, queue_size=1, latch=True)
        cls.updates = rospy.Publisher("virtual_walls_updates", OccupancyGridUpdate, queue_size=1)
        cls.robot = FakeRobot()
        cls.robot.show_map()
        cls.walls.publish(grid_to_msg(virtual_walls(), rospy.Time(0), "map"))
        super().setUpClass()
        cls.costmap = MessageRecorder("move_base/local_costmap/costmap", OccupancyGrid)

    def cost_at(self, point):
        message = self.costmap.wait()
        info = message.info
        col = int((point[0] - info.origin.position.x) / info.resolution)
        row = int((point[1] - info.origin.position.y) / info.resolution)
        return message.data[row * info.width + col]

    def test_a_static_layer_of_the_local_costmap_has_its_own_map_and_its_updates(self):
        self.wait_until(lambda: self.cost_at(WALL) == LETHAL, 10.0)
        self.assertLess(self.cost_at(GAP), LETHAL)
        self.wait_until(lambda: self.updates.get_num_connections() > 0, 10.0)
        update = OccupancyGridUpdate(x=13, y=29, width=1, height=1, data=[LETHAL])
        self.updates.publish(update)
        self.wait_until(lambda: self.cost_at(GAP) == LETHAL, 10.0)

    def test_a_layer_that_is_switched_off_marks_once_it_is_switched_on(self):
        self.robot.cloud_xyz = [(1.025, 0.025, 0.3)]
        rospy.sleep(1.0)
        self.assertLess(self.cost_at(IN_FRONT), LETHAL)
        blind = Client("move_base/local_costmap/blind", timeout=30.0)
        blind.update_configuration({"enabled": True})
        self.wait_until(lambda: self.cost_at(IN_FRONT) == LETHAL, 10.0)

    def test_a_strict_node_names_what_has_no_effect_and_does_not_start(self):
        parameters = rospy.get_param("move_base")
        rospy.set_param("strict", {**parameters, "strict_params": True})
        command = [find_node("move_base_lite", "move_base_lite")[0], "__name:=strict"]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60.0)
        self.assertEqual(run.returncode, 2, run.stderr)
        for name in UNUSED:
            self.assertIn(f"/strict/{name} has no effect", run.stderr)


if __name__ == "__main__":
    rospy.init_node("costmap_layers")
    rostest.rosrun("home_service_tests", "costmap_layers", TestCostmapLayers)
