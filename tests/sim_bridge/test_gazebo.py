#!/usr/bin/env python3
"""Gazebo's services and topics, and control of time."""

import math
import os
import tempfile
import time
import unittest

import gazebo_msgs.srv as srv
import rospy
import rostest
from dynamic_reconfigure.client import Client
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates, PerformanceMetrics
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from sim_bridge_msgs.srv import Step
from std_msgs.msg import Float64
from std_srvs.srv import Empty
from waiting import wait_until

BOX = """<sdf version='1.6'><model name='any'><pose>0 0 0.2 0 0 0</pose><link name='body'>
<inertial><mass>2</mass></inertial>
<collision name='c'><geometry><box><size>0.4 0.4 0.4</size></box></geometry>
<surface><friction><ode><mu>0.1</mu></ode></friction></surface></collision></link></model></sdf>"""
CAN = """<robot name='can'><link name='can'><inertial><mass value='0.3'/>
<inertia ixx='0.001' iyy='0.001' izz='0.001' ixy='0' ixz='0' iyz='0'/></inertial>
<collision><geometry><cylinder radius='0.05' length='0.2'/></geometry></collision></link></robot>"""

MODEL = "<sdf version='1.6'><model name='any'><link name='a'>{}</link></model></sdf>"
URDF_MODEL = "<robot name='any'><link name='a'>{}</link></robot>"
VISUAL = "<visual name='v{}'><geometry><box><size>{} 1 1</size></box></geometry></visual>"
CENTIPEDE = "<sdf version='1.6'><model name='any'>{}</model></sdf>".format(
    "<link name='l0'/>"
    + "".join(
        f"<link name='l{number}'/><joint name='j{number}' type='revolute'><parent>l{number - 1}</parent>"
        f"<child>l{number}</child><axis><xyz>0 0 1</xyz></axis></joint>"
        for number in range(1, 150)
    )
)
LINKS = "<link name='a'/><link name='b'/><link name='c'/>"
HINGE = "<joint name='j{}' type='fixed'><parent link='{}'/><child link='{}'/></joint>"


def call(name, kind, *arguments, **named):
    proxy = rospy.ServiceProxy(name, kind)
    proxy.wait_for_service(20.0)
    return proxy(*arguments, **named)


def pose_at(x, y, z=0.0, yaw=0.0):
    return Pose(Point(x, y, z), Quaternion(0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0)))


def model_state(name, relative_to=""):
    return call("/gazebo/get_model_state", srv.GetModelState, name, relative_to)


def real_time_factor():
    return rospy.wait_for_message("sim_bridge/real_time_factor", Float64, 10.0).data


def yaw_of(pose):
    return 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)


class TestGazebo(unittest.TestCase):
    def setUp(self):
        call("/gazebo/unpause_physics", Empty)
        call("/gazebo/reset_world", Empty)

    def tearDown(self):
        for name in ("crate", "can"):
            call("/gazebo/delete_model", srv.DeleteModel, name)

    def spawn(self, x=0.0, y=0.0, frame="", name="crate"):
        return call("/gazebo/spawn_sdf_model", srv.SpawnModel, name, BOX, "", pose_at(x, y, 0.21), frame)

    def simulated(self, seconds):
        steps = round(seconds / 0.02)
        call("/sim_bridge/step", Step, steps)

    def test_a_paused_simulation_takes_the_requested_steps(self):
        call("/gazebo/pause_physics", Empty)
        before = call("/sim_bridge/step", Step, 0).stamp
        time.sleep(0.3)
        self.assertEqual(call("/sim_bridge/step", Step, 0).stamp, before)
        after = call("/sim_bridge/step", Step, 50).stamp
        self.assertAlmostEqual((after - before).to_sec(), 1.0, places=6)
        world = call("/gazebo/get_world_properties", srv.GetWorldProperties)
        self.assertAlmostEqual(world.sim_time, after.to_sec(), places=6)

    def test_speed_can_be_changed_while_it_runs(self):
        client = Client("sim_bridge", timeout=20.0)
        client.update_configuration({"speed": 2.0})
        self.addCleanup(client.update_configuration, {"speed": 0.0})
        wait_until("twice real time", lambda: abs(real_time_factor() - 2.0) < 0.4)

    def test_performance_metrics_state_the_real_time_factor(self):
        subscriber = rospy.Subscriber("scan", LaserScan, lambda message: None)
        deadline, scans = time.monotonic() + 20.0, None
        while (scans is None or not scans.sim_update_rate) and time.monotonic() < deadline:
            metrics, scans = self.performance_and_scans()
        # Scans were sent for only a part of that period; the next one is whole.
        metrics, scans = self.performance_and_scans()
        subscriber.unregister()
        self.assertGreater(metrics.real_time_factor, 0.0)
        self.assertAlmostEqual(scans.sim_update_rate, 10.0, delta=1.5)

    def performance_and_scans(self):
        metrics = rospy.wait_for_message("/gazebo/performance_metrics", PerformanceMetrics, 10.0)
        return metrics, next((sensor for sensor in metrics.sensors if sensor.name == "/scan"), None)

    def test_reset_world_puts_models_back_and_time_goes_on(self):
        self.spawn(1.0)
        moved = ModelState(model_name="crate", pose=pose_at(2.0, 0.5, 0.21))
        call("/gazebo/set_model_state", srv.SetModelState, moved)
        call(
            "/gazebo/set_model_state",
            srv.SetModelState,
            ModelState("mobile_base", pose_at(0.5, 0.0), Twist(), ""),
        )
        before = call("/sim_bridge/step", Step, 1).stamp
        call("/gazebo/reset_world", Empty)
        self.assertAlmostEqual(model_state("crate").pose.position.x, 1.0, delta=0.01)
        self.assertAlmostEqual(model_state("mobile_base").pose.position.x, 0.0, delta=0.01)
        self.assertGreaterEqual(call("/sim_bridge/step", Step, 0).stamp, before)

    def test_reset_simulation_starts_again_at_time_0(self):
        call("/gazebo/pause_physics", Empty)
        call("/gazebo/reset_simulation", Empty)
        self.assertEqual(call("/sim_bridge/step", Step, 0).stamp.to_sec(), 0.0)
        self.assertAlmostEqual(call("/sim_bridge/step", Step, 5).stamp.to_sec(), 0.1, places=6)
        stamps = []
        odometry = rospy.Subscriber(
            "odom", Odometry, lambda message: stamps.append(message.header.stamp.to_sec())
        )
        call("/gazebo/unpause_physics", Empty)
        wait_until("a message", lambda: stamps)
        odometry.unregister()

    def test_world_properties_list_the_models(self):
        world = call("/gazebo/get_world_properties", srv.GetWorldProperties)
        self.assertTrue(world.success)
        self.assertIn("mobile_base", world.model_names)
        self.assertIn("ground_plane", world.model_names)
        self.assertTrue(world.rendering_enabled)

    def test_a_spawned_model_is_listed_published_and_deleted(self):
        self.assertEqual(self.spawn(1.0).status_message, "SpawnModel: Successfully spawned entity")
        state = model_state("crate")
        self.assertTrue(state.success)
        self.assertAlmostEqual(state.pose.position.x, 1.0, delta=0.01)
        properties = call("/gazebo/get_model_properties", srv.GetModelProperties, "crate")
        self.assertEqual((properties.body_names, properties.is_static), (["body"], False))
        again = self.spawn(1.0)
        self.assertFalse(again.success)
        self.assertEqual(again.status_message, "SpawnModel: Failure - entity already exists.")
        self.assertTrue(call("/gazebo/delete_model", srv.DeleteModel, "crate").success)
        gone = call("/gazebo/delete_model", srv.DeleteModel, "crate")
        self.assertEqual((gone.success, gone.status_message), (False, "DeleteModel: model does not exist"))

    def test_a_urdf_model_can_be_spawned(self):
        pose = pose_at(1.0, 0.0, 0.1)
        self.assertTrue(call("/gazebo/spawn_urdf_model", srv.SpawnModel, "can", CAN, "", pose, "").success)
        self.assertAlmostEqual(model_state("can").pose.position.x, 1.0, delta=0.01)

    def test_what_cannot_be_spawned_is_refused_with_a_reason(self):
        bomb = "<!DOCTYPE x [<!ENTITY a 'b'>]><sdf version='1.6'><model name='&a;'/></sdf>"
        shrunk = BOX.replace("0.4 0.4 0.4", "0.4 -1 0.4")
        unicorn = (
            "<sdf version='1.6'><world name='w'><include><uri>model://unicorn</uri></include></world></sdf>"
        )
        for xml, reason in (
            ("<sdf", "not well-formed XML (unclosed token: line 1, column 0)"),
            (bomb, "refused, defines entities"),
            (shrunk, "box > size: must be positive, got '0.4 -1 0.4'"),
            ("<world/>", "its root is <world>, expected <sdf>"),
            ("<sdf version='1.6'><model name='any'/></sdf>", "has no links"),
            (unicorn, "model://unicorn not found"),
            (CENTIPEDE, "150 parts are connected by joints, at most 128 are supported"),
        ):
            answer = call("/gazebo/spawn_sdf_model", srv.SpawnModel, "crate", xml, "", Pose(), "")
            self.assertFalse(answer.success, xml)
            self.assertTrue(answer.status_message.startswith("SpawnModel: Failure - crate"), answer)
            self.assertIn(reason, answer.status_message)
        self.assertEqual(
            self.spawn(frame="nothing").status_message,
            "SpawnModel: reference reference_frame not found, "
            "did you forget to scope the link by model name?",
        )
        self.assertEqual(self.spawn(math.nan).status_message, "SpawnModel: Failure - the pose is not finite")

    def test_what_takes_long_to_read_or_cannot_be_read_does_not_hold_up_time(self):
        fork = "".join(HINGE.format(number, *ends) for number, ends in enumerate(("ab", "bc", "cb")))
        with tempfile.TemporaryDirectory() as folder:
            os.mkfifo(f"{folder}/pipe.obj")
            mesh = f"<collision><geometry><mesh {{}}file://{folder}/pipe.obj{{}}</geometry></collision>"
            for kind, xml, reason in (
                ("sdf", MODEL.format(mesh.format("><uri>", "</uri></mesh>")), "not a regular file"),
                ("urdf", URDF_MODEL.format(mesh.format('filename="', '"/>')), "not a regular file"),
                ("urdf", f"<robot name='r'>{LINKS}{fork}</robot>", "joints form a loop: "),
            ):
                self.refused_while_time_passes(kind, xml, reason)

    def test_time_goes_on_while_a_large_model_is_read(self):
        count, seconds = 1000, 0.0
        while seconds < 1.5:  # or it is no test
            count *= 2
            visuals = "".join(VISUAL.format(number, 1) for number in range(count)) + VISUAL.format("", -1)
            reason = "box > size: must be positive, got '-1 1 1'"
            seconds = self.refused_while_time_passes("sdf", MODEL.format(visuals), reason)

    def refused_while_time_passes(self, kind, xml, reason):
        """The seconds that it took."""
        answer, seconds, standstill = self.spawned_while_time_passes(kind, xml)
        self.assertFalse(answer.success)
        self.assertIn(reason, answer.status_message)
        self.assertLess(seconds, 20.0)
        self.assertLess(standstill, max(0.5, 0.5 * seconds), f"while {kind} took {seconds:.1f} s")
        return seconds

    def spawned_while_time_passes(self, kind, xml):
        """The answer, how long it took, and how long the clock stood still meanwhile; wall seconds."""
        ticks = []
        clock = rospy.Subscriber("/clock", Clock, lambda message: ticks.append(time.monotonic()))
        wait_until("the clock", lambda: len(ticks) > 1)
        begin = time.monotonic()
        answer = call(f"/gazebo/spawn_{kind}_model", srv.SpawnModel, "crate", xml, "", Pose(), "")
        end = time.monotonic()
        wait_until("time to go on", lambda: ticks[-1] > end)
        clock.unregister()
        during = [begin, *(tick for tick in ticks if begin < tick < end), end]
        return answer, end - begin, max(later - earlier for earlier, later in zip(during, during[1:]))

    def test_states_are_relative_to_the_frame_asked_for(self):
        state = ModelState("mobile_base", pose_at(1.0, 0.0, 0.0, math.pi / 2.0), Twist(), "world")
        self.assertTrue(call("/gazebo/set_model_state", srv.SetModelState, state).success)
        self.assertTrue(self.spawn(1.0, 0.0, frame="mobile_base").success)
        in_world, in_robot = model_state("crate").pose, model_state("crate", "mobile_base").pose
        self.assertAlmostEqual(in_world.position.y, 1.0, delta=0.02)
        self.assertAlmostEqual(in_robot.position.x, 1.0, delta=0.02)
        self.assertAlmostEqual(yaw_of(in_robot), 0.0, delta=0.02)

    def test_states_of_what_is_not_there_fail_as_gazebos_do(self):
        for answer, text in (
            (model_state("nothing"), "GetModelState: model does not exist"),
            (
                model_state("mobile_base", "nothing"),
                "GetModelState: reference relative_entity_name not found, "
                "did you forget to scope the body by model name?",
            ),
            (
                call("/gazebo/set_model_state", srv.SetModelState, ModelState(model_name="nothing")),
                "SetModelState: model does not exist",
            ),
            (
                call("/gazebo/get_link_state", srv.GetLinkState, "nothing", ""),
                "GetLinkState: link not found, did you forget to scope the link by model name?",
            ),
            (
                call("/gazebo/set_link_state", srv.SetLinkState, LinkState(link_name="nothing")),
                "SetLinkState: link does not exist",
            ),
            (
                call("/gazebo/get_model_properties", srv.GetModelProperties, "nothing"),
                "GetModelProperties: model does not exist",
            ),
            (
                call("/gazebo/apply_body_wrench", srv.ApplyBodyWrench, body_name="nothing"),
                "ApplyBodyWrench: body does not exist",
            ),
        ):
            self.assertEqual((answer.success, answer.status_message), (False, text))

    def test_link_states_can_be_got_and_set(self):
        self.spawn(1.0)
        state = LinkState("crate::body", pose_at(1.5, 0.2, 0.2), Twist(), "")
        self.assertTrue(call("/gazebo/set_link_state", srv.SetLinkState, state).success)
        state = call("/gazebo/get_link_state", srv.GetLinkState, "crate::body", "").link_state
        self.assertAlmostEqual(state.pose.position.x, 1.5, delta=0.01)
        unscoped = call("/gazebo/get_link_state", srv.GetLinkState, "body", "base_footprint")
        self.assertTrue(unscoped.success, "as in Gazebo, if the name is the only one")

    def test_responses_have_sequence_number_frame_and_time(self):
        first, second = (model_state("mobile_base", "ground_plane").header for _ in range(2))
        self.assertEqual((second.seq, second.frame_id), (first.seq + 1, "ground_plane"))
        self.assertGreaterEqual(second.stamp, first.stamp)
        self.assertGreater(first.stamp.to_sec(), 0.0)

    def test_states_that_are_not_finite_are_refused(self):
        lost, fast = pose_at(math.nan, 0.0), Twist(linear=Vector3(math.inf, 0.0, 0.0))
        for answer, text in (
            (
                call(
                    "/gazebo/set_model_state", srv.SetModelState, ModelState("mobile_base", lost, Twist(), "")
                ),
                "SetModelState: the pose is not finite",
            ),
            (
                call(
                    "/gazebo/set_model_state", srv.SetModelState, ModelState("mobile_base", Pose(), fast, "")
                ),
                "SetModelState: the twist is not finite",
            ),
            (
                call(
                    "/gazebo/set_link_state",
                    srv.SetLinkState,
                    LinkState("mobile_base::base_footprint", lost, Twist(), ""),
                ),
                "SetLinkState: the pose is not finite",
            ),
        ):
            self.assertEqual((answer.success, answer.status_message), (False, text))
        self.assertTrue(math.isfinite(model_state("mobile_base").pose.position.x))

    def test_impossible_states_are_refused_and_time_goes_on(self):
        far, fast = pose_at(1e308, 0.0), Twist(angular=Vector3(0.0, 0.0, 1e308))
        for pose, twist, text in (
            (far, Twist(), "SetModelState: nothing can be at the pose"),
            (Pose(), fast, "SetModelState: nothing is as fast as the twist"),
        ):
            state = ModelState("mobile_base", pose, twist, "")
            answer = call("/gazebo/set_model_state", srv.SetModelState, state)
            self.assertEqual((answer.success, answer.status_message), (False, text))
        self.simulated(0.1)
        self.assertLess(abs(model_state("mobile_base").pose.position.x), 1.0)

    def test_a_zero_quaternion_is_the_identity(self):
        for turn in (Quaternion(), Quaternion(0.0, 0.0, 1e-200, 0.0)):
            state = ModelState("mobile_base", Pose(Point(0.5, 0.0, 0.0), turn), Twist(), "")
            self.assertTrue(call("/gazebo/set_model_state", srv.SetModelState, state).success)
            self.simulated(0.1)
            pose = model_state("mobile_base").pose
            self.assertAlmostEqual(pose.position.x, 0.5, delta=0.01)
            self.assertAlmostEqual(yaw_of(pose), 0.0, delta=0.01)

    def test_states_can_be_set_by_topic(self):
        publisher = rospy.Publisher("/gazebo/set_model_state", ModelState, queue_size=1)
        wait_until("the simulator", publisher.get_num_connections)
        publisher.publish(ModelState("mobile_base", pose_at(0.6, 0.0), Twist(), ""))
        wait_until("the robot", lambda: abs(model_state("mobile_base").pose.position.x - 0.6) < 0.01)
        self.spawn(1.0)
        links = rospy.Publisher("/gazebo/set_link_state", LinkState, queue_size=1)
        wait_until("the simulator", links.get_num_connections)
        links.publish(LinkState("crate::body", pose_at(1.5, 0.2, 0.2), Twist(), ""))
        wait_until("the crate", lambda: abs(model_state("crate").pose.position.x - 1.5) < 0.01)

    def test_all_models_and_links_are_published(self):
        models = rospy.wait_for_message("/gazebo/model_states", ModelStates, 10.0)
        self.assertIn("mobile_base", models.name)
        self.assertEqual(len(models.name), len(models.pose))
        links = rospy.wait_for_message("/gazebo/link_states", LinkStates, 10.0)
        self.assertIn("mobile_base::base_footprint", links.name)
        self.assertEqual(len(links.name), len(links.twist))

    def test_a_wrench_pushes_for_its_duration(self):
        self.spawn(1.0)
        call("/gazebo/pause_physics", Empty)
        self.simulated(0.2)
        before = model_state("crate").pose.position.y
        push = Wrench(Vector3(0.0, 8.0, 0.0), Vector3())
        answer = call(
            "/gazebo/apply_body_wrench", srv.ApplyBodyWrench, "crate::body", "", Point(), push,
            rospy.Time(0), rospy.Duration(0.5),
        )  # fmt: skip
        self.assertTrue(answer.success)
        self.simulated(0.4)
        self.assertGreater(model_state("crate").twist.linear.y, 0.5)
        self.simulated(3.0)
        self.assertAlmostEqual(model_state("crate").twist.linear.y, 0.0, delta=0.01)
        self.assertGreater(model_state("crate").pose.position.y, before + 0.2)
        call(
            "/gazebo/apply_body_wrench", srv.ApplyBodyWrench, "crate::body", "", Point(), push,
            rospy.Time(0), rospy.Duration(-1),
        )  # fmt: skip
        call("/gazebo/clear_body_wrenches", srv.BodyRequest, "crate::body")
        self.simulated(0.5)
        self.assertAlmostEqual(model_state("crate").twist.linear.y, 0.0, delta=0.01)

    def test_physics_properties_can_be_got_and_set(self):
        kept = call("/gazebo/get_physics_properties", srv.GetPhysicsProperties)
        self.assertAlmostEqual(kept.time_step, 0.005)
        self.assertAlmostEqual(kept.gravity.z, -9.8)
        change = srv.SetPhysicsPropertiesRequest(0.0025, 0.0, kept.gravity, kept.ode_config)
        self.assertTrue(call("/gazebo/set_physics_properties", srv.SetPhysicsProperties, change).success)
        changed = call("/gazebo/get_physics_properties", srv.GetPhysicsProperties)
        self.assertAlmostEqual(changed.time_step, 0.0025)
        self.assertEqual(changed.max_update_rate, 0.0)
        change.time_step = 0.013
        for time_step, reason in (
            (0.013, "odometry_rate must be a divisor of physics_rate (77), got 50"),
            (1e-9, "time_step must be at least 1e-05, max_update_rate not negative"),
            (math.nan, "time_step must be at least 1e-05, max_update_rate not negative"),
        ):
            change.time_step = time_step
            refused = call("/gazebo/set_physics_properties", srv.SetPhysicsProperties, change)
            self.assertEqual(refused.status_message, f"SetPhysicsProperties: {reason}")
            self.assertFalse(refused.success)
        change.time_step = 0.005
        call("/gazebo/set_physics_properties", srv.SetPhysicsProperties, change)

    def test_physics_can_be_reconfigured(self):
        client = Client("/gazebo", timeout=20.0)
        before = client.get_configuration()
        self.assertEqual((before["time_step"], before["gravity_z"]), (0.005, -9.8))
        self.assertEqual(client.update_configuration({"gravity_z": -1.6})["gravity_z"], -1.6)
        properties = call("/gazebo/get_physics_properties", srv.GetPhysicsProperties)
        self.assertEqual((properties.gravity.z, properties.time_step), (-1.6, 0.005))
        kept = client.update_configuration({"gravity_x": 3.0})
        self.assertEqual((kept["gravity_x"], kept["gravity_z"]), (0.0, -1.6), "only along z")
        client.update_configuration({"gravity_z": -9.8})


if __name__ == "__main__":
    rospy.init_node("gazebo_test")
    rostest.rosrun("home_service_tests", "gazebo", TestGazebo)
