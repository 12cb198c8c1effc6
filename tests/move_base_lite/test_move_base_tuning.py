#!/usr/bin/env python3
"""Changes of move_base_lite at run time: dynamic_reconfigure, footprint, zones."""

import dynamic_reconfigure.client
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point32, Polygon, PolygonStamped
from move_base_client import MessageRecorder, MoveBaseTestCase, points_of, pose_at
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetPlan
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Empty, SetBool
from visualization_msgs.msg import MarkerArray

OFFICIAL = {
    "move_base": {
        "base_global_planner", "base_local_planner", "planner_frequency", "controller_frequency",
        "planner_patience", "controller_patience", "max_planning_retries", "conservative_reset_dist",
        "recovery_behavior_enabled", "clearing_rotation_allowed", "shutdown_costmaps", "oscillation_timeout",
        "oscillation_distance", "make_plan_clear_costmap", "make_plan_add_unreachable_goal",
        "restore_defaults",
    },
    "move_base/local_costmap": {
        "transform_tolerance", "update_frequency", "publish_frequency", "width", "height", "resolution",
        "origin_x", "origin_y", "footprint", "robot_radius", "footprint_padding",
    },
    "move_base/global_costmap/static_layer": {"enabled"},
    "move_base/global_costmap/obstacle_layer": {
        "enabled", "footprint_clearing_enabled", "max_obstacle_height", "combination_method",
    },
    "move_base/local_costmap/inflation_layer": {
        "enabled", "cost_scaling_factor", "inflation_radius", "inflate_unknown",
    },
    "move_base/DWAPlannerROS": {
        "max_vel_trans", "min_vel_trans", "max_vel_x", "min_vel_x", "max_vel_y", "min_vel_y",
        "max_vel_theta", "min_vel_theta", "acc_lim_x", "acc_lim_y", "acc_lim_theta", "acc_lim_trans",
        "prune_plan", "xy_goal_tolerance", "yaw_goal_tolerance", "trans_stopped_vel", "theta_stopped_vel",
        "restore_defaults", "sim_time", "sim_granularity", "angular_sim_granularity", "path_distance_bias",
        "goal_distance_bias", "occdist_scale", "twirling_scale", "stop_time_buffer",
        "oscillation_reset_dist", "oscillation_reset_angle", "forward_point_distance", "scaling_speed",
        "max_scaling_factor", "vx_samples", "vy_samples", "vth_samples", "use_dwa",
    },
}  # fmt: skip


INSCRIBED = 253
SLOW_COMMANDS = 10


def client_of(name):
    return dynamic_reconfigure.client.Client(name, timeout=60.0)


class TestMoveBaseTuning(MoveBaseTestCase):
    def tune(self, name, **values):
        """Change values, and restore them after the test."""
        client = client_of(name)
        before = client.get_configuration(timeout=10.0)
        self.addCleanup(lambda: client.update_configuration({key: before[key] for key in values}))
        return client.update_configuration(values)

    def cost_at(self, topic, x, y):
        """Value of the latest full costmap at a point of its frame."""
        costmap = MessageRecorder(topic, OccupancyGrid)
        info = costmap.wait().info
        column = int((x - info.origin.position.x) / info.resolution)
        row = int((y - info.origin.position.y) / info.resolution)
        costmap.close()
        return costmap.messages[-1].data[row * info.width + column]

    def test_the_servers_have_the_official_parameters(self):
        self.tune("move_base", base_local_planner="dwa_local_planner/DWAPlannerROS")
        for name, official in OFFICIAL.items():
            known = {entry["name"] for entry in client_of(name).get_parameter_descriptions(timeout=20.0)}
            self.assertLessEqual(official, known, name)

    def test_a_lower_speed_holds_at_once(self):
        self.drive(self.far_goal())
        self.tune("move_base/MppiPlannerROS", max_vel_x=0.15)
        at = rospy.get_time()

        def is_slow():
            latest = self.commands.since(at)[-SLOW_COMMANDS:]
            return len(latest) == SLOW_COMMANDS and max(sent.linear.x for sent in latest) <= 0.15 + 1e-6

        self.wait_until(is_slow, 3.0)
        self.assertTrue(self.has_active_goal())

    def test_the_local_planner_is_replaced_while_driving(self):
        costs, trajectories = (
            MessageRecorder(f"move_base/DWAPlannerROS/{name}", PointCloud2)
            for name in ("cost_cloud", "trajectory_cloud")
        )
        self.drive(self.far_goal())
        config = self.tune("move_base", base_local_planner="dwa_local_planner/DWAPlannerROS")
        self.assertEqual(config["base_local_planner"], "dwa_local_planner/DWAPlannerROS")
        fields = points_of(costs.wait())
        self.assertEqual(list(fields), ["x", "y", "z", "path_cost", "goal_cost", "occ_cost", "total_cost"])
        self.assertLess(fields["occ_cost"].max(), INSCRIBED)
        fields = points_of(trajectories.wait())
        self.assertEqual(list(fields), ["x", "y", "z", "theta", "cost"])
        self.assertGreater(len(set(fields["cost"])), 10, "trajectories evaluated")
        self.assertEqual({trajectories.wait().header.frame_id, costs.wait().header.frame_id}, {"odom"})
        self.assertEqual(self.result_of()[0], GoalStatus.SUCCEEDED)

    def test_an_unknown_planner_is_refused(self):
        config = self.tune("move_base", base_global_planner="nowhere/Planner", planner_patience=3.0)
        self.assertEqual(config["base_global_planner"], "navfn/NavfnROS")
        self.assertEqual(config["planner_patience"], 5.0)

    def test_invalid_values_change_nothing(self):
        config = self.tune("move_base/MppiPlannerROS", max_vel_x=-2.0)
        self.assertEqual(config["max_vel_x"], 0.6)

    def test_defaults_are_restored(self):
        client = client_of("move_base/global_costmap/inflation_layer")
        self.assertEqual(client.update_configuration({"inflation_radius": 0.3})["inflation_radius"], 0.3)
        self.assertEqual(client.update_configuration({"restore_defaults": True})["inflation_radius"], 0.6)

    def test_less_inflation_shows_in_the_costmap(self):
        topic = "move_base/global_costmap/costmap"
        wall = (4.9, 2.0)  # 0.3 m off the outer wall
        self.assertGreater(self.cost_at(topic, *wall), 20)
        self.tune("move_base/global_costmap/inflation_layer", inflation_radius=0.22)
        self.wait_until(lambda: self.cost_at(topic, *wall) == 0)

    def test_a_layer_is_switched_off_and_on(self):
        plan = rospy.ServiceProxy("move_base/make_plan", GetPlan)
        rospy.ServiceProxy("move_base/clear_costmaps", Empty)()
        through_a_wall_out_of_sight = pose_at(-2.0, 1.0), pose_at(-2.0, 3.0), 0.0
        length = len(plan(*through_a_wall_out_of_sight).plan.poses)
        self.tune("move_base/global_costmap/static_layer", enabled=False)
        self.assertLess(len(plan(*through_a_wall_out_of_sight).plan.poses), 0.5 * length)
        self.tune("move_base/global_costmap/static_layer", enabled=True)
        self.assertEqual(len(plan(*through_a_wall_out_of_sight).plan.poses), length)

    def test_a_footprint_from_the_topic_is_applied_and_published(self):
        shown = MessageRecorder("move_base/local_costmap/footprint", PolygonStamped)
        self.assertEqual(len(shown.wait().polygon.points), 16)
        publisher = rospy.Publisher("move_base/local_costmap/footprint", Polygon, queue_size=1)
        self.tune("move_base/local_costmap", footprint="[]")
        corners = [(0.3, 0.2), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.2)]
        self.wait_until(publisher.get_num_connections)
        publisher.publish(Polygon([Point32(x, y, 0.0) for x, y in corners]))
        self.wait_until(lambda: len(shown.messages[-1].polygon.points) == 4)

    def test_a_zone_is_switched_on_and_off(self):
        markers = MessageRecorder("move_base/zones/markers", MarkerArray)
        self.assertEqual([marker.type for marker in markers.wait().markers], [4, 4])
        switch = rospy.ServiceProxy("move_base/zones/doorway", SetBool)
        answer = switch(True)
        self.assertEqual((answer.success, answer.message), (True, "zone doorway (keep_out) is on"))
        state, text = self.end_of(pose_at(1.0, 0.0))
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertIn("[code=GOAL_BLOCKED: the goal at (1.00, 0.00) is in the keep-out zone doorway]", text)
        switch(False)
        self.assertEqual(self.end_of(pose_at(1.0, 0.0))[0], GoalStatus.SUCCEEDED)

    def test_the_robot_is_slow_in_a_speed_zone(self):
        rospy.ServiceProxy("move_base/zones/slow", SetBool)(True)
        self.addCleanup(rospy.ServiceProxy("move_base/zones/slow", SetBool), False)
        at = rospy.get_time()
        self.assertEqual(self.end_of(pose_at(0.2, 0.1))[0], GoalStatus.SUCCEEDED)
        self.assertLessEqual(max(command.linear.x for command in self.commands.since(at)), 0.2 + 1e-6)


if __name__ == "__main__":
    rospy.init_node("move_base_tuning")
    rostest.rosrun("home_service_tests", "move_base_tuning", TestMoveBaseTuning)
