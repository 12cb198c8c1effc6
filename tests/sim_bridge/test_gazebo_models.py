#!/usr/bin/env python3
"""Gazebo's services for joints, links and lights of models that are more than one body."""

import math
import unittest

import gazebo_msgs.srv as srv
import rospy
import rostest
from gazebo_msgs.msg import LinkState, ODEJointProperties
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from sim_bridge_msgs.srv import Step
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Empty

# A door on a post, and a drawer that slides.
CABINET = """<sdf version='1.6'><model name='any'>
<link name='post'><pose>0 0 0.5 0 0 0</pose><inertial><mass>50</mass></inertial>
<collision name='foot'><geometry><box><size>0.4 0.4 1</size></box></geometry></collision></link>
<link name='door'><pose>0.5 0 0.6 0 0 0</pose><inertial><mass>2</mass>
<inertia><ixx>0.2</ixx><iyy>0.3</iyy><izz>0.4</izz></inertia></inertial>
<collision name='leaf'><geometry><box><size>0.5 0.02 0.8</size></box></geometry></collision></link>
<link name='drawer'><pose>0 0 1.2 0 0 0</pose><inertial><mass>1</mass></inertial></link>
<joint name='hinge' type='revolute'><parent>post</parent><child>door</child><pose>-0.25 0 0 0 0 0</pose>
<axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1.5</upper></limit>
<dynamics><damping>0.1</damping></dynamics></axis></joint>
<joint name='rail' type='prismatic'><parent>post</parent><child>drawer</child>
<axis><xyz>1 0 0</xyz><limit><lower>0</lower><upper>0.4</upper></limit></axis></joint>
</model></sdf>"""


def call(name, kind, *arguments, **named):
    proxy = rospy.ServiceProxy(f"/gazebo/{name}", kind)
    proxy.wait_for_service(20.0)
    return proxy(*arguments, **named)


def simulated(seconds):
    rospy.ServiceProxy("/sim_bridge/step", Step)(round(seconds / 0.02))


def joint(name):
    return call("get_joint_properties", srv.GetJointProperties, name)


class TestModels(unittest.TestCase):
    def setUp(self):
        call("pause_physics", Empty)
        pose = Pose(Point(2.0, 0.0, 0.0), Quaternion(w=1.0))
        spawned = call("spawn_sdf_model", srv.SpawnModel, "cabinet", CABINET, "", pose, "")
        self.assertTrue(spawned.success, spawned.status_message)

    def tearDown(self):
        call("delete_model", srv.DeleteModel, "cabinet")

    def test_a_model_names_its_links_solids_and_joints(self):
        properties = call("get_model_properties", srv.GetModelProperties, "cabinet")
        self.assertEqual(properties.body_names, ["post", "door", "drawer"])
        self.assertEqual(properties.geom_names, ["foot", "leaf"])
        self.assertEqual(properties.joint_names, ["hinge", "rail"])
        self.assertEqual(properties.canonical_body_name, "post")

    def test_joints_have_a_type_and_a_position(self):
        hinge, rail = joint("hinge"), joint("cabinet::rail")
        self.assertEqual((hinge.type, rail.type), (hinge.REVOLUTE, rail.PRISMATIC))
        self.assertEqual(list(hinge.damping), [0.1])
        self.assertAlmostEqual(hinge.position[0], 0.0, delta=1e-3)
        self.assertEqual(hinge.status_message, "GetJointProperties: got properties")

    def test_a_model_is_configured_by_its_joints(self):
        done = call(
            "set_model_configuration", srv.SetModelConfiguration, "cabinet", "", ["hinge", "rail"], [0.5, 0.3]
        )
        self.assertEqual((done.success, done.status_message), (True, "SetModelConfiguration: success"))
        self.assertAlmostEqual(joint("hinge").position[0], 0.5, places=3)
        drawer = call("get_link_state", srv.GetLinkState, "cabinet::drawer", "cabinet::post").link_state
        self.assertAlmostEqual(drawer.pose.position.x, 0.3, places=3)

    def test_an_effort_opens_the_door_as_far_as_it_goes_and_can_be_taken_back(self):
        forever = rospy.Duration(-1)
        done = call("apply_joint_effort", srv.ApplyJointEffort, "hinge", 2.0, rospy.Time(0), forever)
        self.assertEqual((done.success, done.status_message), (True, "ApplyJointEffort: effort set"))
        simulated(3.0)
        self.assertAlmostEqual(joint("hinge").position[0], 1.5, delta=0.05)
        call("clear_joint_forces", srv.JointRequest, "hinge")
        call("apply_joint_effort", srv.ApplyJointEffort, "hinge", -1.0, rospy.Time(0), rospy.Duration(0.5))
        simulated(0.5)
        self.assertLess(joint("hinge").position[0], 1.4)

    def test_limits_of_a_joint_can_be_changed(self):
        config = ODEJointProperties(loStop=[0.0], hiStop=[0.7], damping=[1.0])
        done = call("set_joint_properties", srv.SetJointProperties, "hinge", config)
        self.assertEqual((done.success, done.status_message), (True, "SetJointProperties: properties set"))
        self.assertEqual(list(joint("hinge").damping), [1.0])
        call("apply_joint_effort", srv.ApplyJointEffort, "hinge", 3.0, rospy.Time(0), rospy.Duration(3.0))
        simulated(3.0)
        self.assertAlmostEqual(joint("hinge").position[0], 0.7, delta=0.05)

    def test_mass_and_inertia_of_a_link_can_be_got_and_set(self):
        properties = call("get_link_properties", srv.GetLinkProperties, "cabinet::door")
        self.assertEqual(properties.mass, 2.0)
        self.assertAlmostEqual(properties.ixx, 0.2)
        self.assertAlmostEqual(properties.izz, 0.4)
        self.assertTrue(properties.gravity_mode)
        change = srv.SetLinkPropertiesRequest(link_name="cabinet::door", mass=3.0, ixx=0.4, iyy=0.6, izz=0.8)
        done = call("set_link_properties", srv.SetLinkProperties, change)
        self.assertEqual((done.success, done.status_message), (True, "SetLinkProperties: properties set"))
        properties = call("get_link_properties", srv.GetLinkProperties, "cabinet::door")
        self.assertEqual((properties.mass, properties.gravity_mode), (3.0, False))
        self.assertAlmostEqual(properties.iyy, 0.6)
        change.mass = -1.0
        self.assertFalse(call("set_link_properties", srv.SetLinkProperties, change).success)

    def test_setting_a_link_takes_the_whole_model_along(self):
        pose = Pose(Point(0.0, 3.0, 0.6), Quaternion(0.0, 0.0, math.sin(0.25), math.cos(0.25)))
        done = call("set_link_state", srv.SetLinkState, LinkState("cabinet::door", pose, Twist(), ""))
        self.assertTrue(done.success, done.status_message)
        door = call("get_link_state", srv.GetLinkState, "cabinet::door", "").link_state.pose.position
        post = call("get_link_state", srv.GetLinkState, "cabinet::post", "cabinet::door").link_state
        self.assertAlmostEqual(door.y, 3.0, places=3)
        self.assertAlmostEqual(post.pose.position.x, -0.5, places=3)

    def test_the_sun_is_known_set_and_deleted(self):
        properties = call("get_light_properties", srv.GetLightProperties, "sun")
        self.assertTrue(properties.success)
        change = srv.SetLightPropertiesRequest(light_name="sun", diffuse=ColorRGBA(1.0, 0.5, 0.0, 1.0))
        self.assertTrue(call("set_light_properties", srv.SetLightProperties, change).success)
        properties = call("get_light_properties", srv.GetLightProperties, "sun")
        self.assertAlmostEqual(properties.diffuse.g, 0.5)
        done = call("delete_light", srv.DeleteLight, "sun")
        self.assertEqual(done.status_message, "DeleteLight: sun successfully deleted")

    def test_what_is_not_there_fails_as_in_gazebo(self):
        lists = ["hinge"], [0.1, 0.2]
        for answer, text in (
            (joint("nothing"), "GetJointProperties: joint not found"),
            (
                call("set_joint_properties", srv.SetJointProperties, "nothing", ODEJointProperties()),
                "SetJointProperties: joint not found",
            ),
            (
                call("apply_joint_effort", srv.ApplyJointEffort, joint_name="nothing"),
                "ApplyJointEffort: joint not found",
            ),
            (
                call("set_model_configuration", srv.SetModelConfiguration, "nothing", "", [], []),
                "SetModelConfiguration: model does not exist",
            ),
            (
                call("set_model_configuration", srv.SetModelConfiguration, "cabinet", "", *lists),
                "SetModelConfiguration: joint name and position list have different lengths",
            ),
            (
                call("get_link_properties", srv.GetLinkProperties, "nothing"),
                "GetLinkProperties: link not found, did you forget to scope the link by model name?",
            ),
            (
                call("set_link_properties", srv.SetLinkProperties, link_name="nothing"),
                "SetLinkProperties: link not found, did you forget to scope the link by model name?",
            ),
            (
                call("get_light_properties", srv.GetLightProperties, "nothing"),
                "getLightProperties: Requested light nothing not found!",
            ),
            (
                call("set_light_properties", srv.SetLightProperties, light_name="nothing"),
                "setLightProperties: Requested light nothing not found!",
            ),
            (
                call("delete_light", srv.DeleteLight, "nothing"),
                "DeleteLight: Requested light nothing not found!",
            ),
        ):
            self.assertEqual((answer.success, answer.status_message), (False, text))


if __name__ == "__main__":
    rospy.init_node("gazebo_models_test")
    rostest.rosrun("home_service_tests", "gazebo_models", TestModels)
