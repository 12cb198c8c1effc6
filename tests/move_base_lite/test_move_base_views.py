#!/usr/bin/env python3
"""Topics of GlobalPlanner and TrajectoryPlannerROS as of the official ones; clearing of costmaps."""

import numpy as np
import rospy
import rostest
from fake_robot import FakeRobot
from geometry_msgs.msg import PoseStamped
from move_base_client import MessageRecorder, MoveBaseTestCase, points_of, pose_at
from nav_msgs.msg import OccupancyGrid, Path
from nav_msgs.srv import GetPlan
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Empty

NEXT_ROOM, WALL = (5.2, 2.0), (3.2, 1.0)
# A box in the next room, which no laser beam clears: in the map, and relative to the robot at (1, 2).
BOX = (3.97, 0.92)
BOX_CLOUD = [(2.92 + 0.05 * i, -1.08, 0.3) for i in range(4)]
LETHAL, PUBLISH_SCALE = 100, 100


class TestMoveBaseViews(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = FakeRobot()
        cls.robot.show_map()
        rospy.sleep(0.5)  # until there is a clock
        super().setUpClass()

    def test_clearing_the_costmaps_removes_observations_and_keeps_the_map(self):
        costmaps = [
            MessageRecorder(f"move_base/{name}/costmap", OccupancyGrid)
            for name in ("global_costmap", "local_costmap")
        ]
        clear = rospy.ServiceProxy("move_base/clear_costmaps", Empty)

        def at_box():
            return [self.cost_at(costmap, BOX) for costmap in costmaps]

        before = at_box()
        self.assertLess(max(before), LETHAL)
        self.robot.cloud_xyz = BOX_CLOUD
        self.wait_until(lambda: at_box() == [LETHAL] * 2, 5.0)
        self.robot.cloud_xyz = None
        rospy.sleep(1.0)
        self.assertEqual(at_box(), [LETHAL] * 2)
        clear()
        self.wait_until(lambda: at_box() == before, 2.0)
        self.assertEqual(self.cost_at(costmaps[0], WALL), LETHAL)

    def cost_at(self, costmap, point):
        message = costmap.wait()
        info = message.info
        col = int((point[0] - info.origin.position.x) / info.resolution)
        row = int((point[1] - info.origin.position.y) / info.resolution)
        return message.data[row * info.width + col]

    def test_the_potential_of_a_plan_is_a_grid(self):
        potential = MessageRecorder("move_base/GlobalPlanner/potential", OccupancyGrid).connected()
        make_plan = rospy.ServiceProxy("move_base/GlobalPlanner/make_plan", GetPlan)
        self.assertTrue(make_plan(PoseStamped(), pose_at(*NEXT_ROOM), 0.0).plan.poses)
        grid = potential.wait()
        self.assertEqual((grid.header.frame_id, grid.info.width, grid.info.height), ("map", 128, 80))
        cells = np.array(grid.data).reshape(80, 128)
        robot = self.robot.base_in_map
        at_robot = cells[int(robot.y / grid.info.resolution), int(robot.x / grid.info.resolution)]
        at_goal, in_wall = cells[40, 104], cells[20, 64]
        self.assertEqual((at_robot, in_wall, cells.max()), (0, -1, PUBLISH_SCALE))
        self.assertGreater(at_goal, cells[40, 64])

    def test_the_cost_cloud_is_published_while_driving(self):
        plan = MessageRecorder("move_base/GlobalPlanner/plan", Path).connected()
        costs = MessageRecorder("move_base/TrajectoryPlannerROS/cost_cloud", PointCloud2).connected()
        self.drive(pose_at(*NEXT_ROOM))
        self.assertEqual(costs.wait().header.frame_id, "odom")
        self.assertLess(rospy.get_time() - costs.wait().header.stamp.to_sec(), 1.0)
        self.assertEqual(plan.wait().header.frame_id, "map")
        fields = points_of(costs.wait())
        self.assertEqual(list(fields), ["x", "y", "z", "path_cost", "goal_cost", "occ_cost", "total_cost"])
        nearest = fields["path_cost"].argmin()
        self.assertAlmostEqual(fields["y"][nearest], 2.0, delta=0.3, msg="the plan leads through the door")


if __name__ == "__main__":
    rospy.init_node("move_base_views")
    rostest.rosrun("home_service_tests", "move_base_views", TestMoveBaseViews)
