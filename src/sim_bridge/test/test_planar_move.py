"""Omnidirectional robots, driven by gazebo_ros_planar_move."""

import math

import numpy as np
import pytest

from planar import Pose2, Twist2
from sim_bridge import Scene, SimulationSettings
from sim_bridge.description import read_sdf_robot, read_urdf_robot
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.noise import NOISE_PROFILES
from sim_bridge.sdf import read_model
from sim_bridge.world import Body, Collision, World

ROBOT = """<robot name="cart"><link name="base_footprint"/><link name="base">
<inertial><origin xyz="0.05 0 0"/><mass value="10"/><inertia ixx="0.4" iyy="0.4" izz="0.5"/></inertial>
<collision><geometry><box size="0.5 0.3 0.2"/></geometry></collision></link>
<joint name="j" type="fixed"><parent link="base_footprint"/><child link="base"/>
<origin xyz="0 0 0.11"/></joint>
<gazebo><plugin name="p" filename="libgazebo_ros_planar_move.so">{}</plugin></gazebo></robot>"""
FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
WALL = Body("wall::link", pose3(1.0, 0.0, 0.5), (Collision(Box((0.1, 4.0, 1.0)), np.eye(4)),))


def robot(parameters=""):
    return read_urdf_robot(ROBOT.format(parameters), "cart.urdf")


def scene_with(profile, *bodies, start=Pose2()):
    scene = Scene(World("w", (FLOOR, *bodies)), SimulationSettings(**vars(NOISE_PROFILES["ideal"])))
    scene.add_robot("cart", profile, start)
    return scene


def drive(scene, seconds, twist=None):
    for _ in range(round(seconds / scene.step_seconds)):
        result = scene.step({} if twist is None else {"cart": twist})["cart"]
    return result


def test_the_defaults_are_those_of_the_plugin():
    profile = robot()
    assert profile.drive.is_omnidirectional
    assert profile.drive.command_topics == ("cmd_vel",)
    assert profile.drive.command_timeout == math.inf
    odometry = profile.odometry
    assert (odometry.topic, odometry.frame, odometry.base_frame) == ("odom", "odom", "base_footprint")
    assert (odometry.source, odometry.rate, odometry.sends_transform) == ("world", 20.0, True)
    assert odometry.variances == (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    assert profile.warnings == ()


def test_the_parameters_of_the_plugin_are_read():
    profile = robot(
        "<robotNamespace>r</robotNamespace><commandTopic>go</commandTopic><odometryTopic>where</odometryTopic>"
        "<odometryFrame>o</odometryFrame><robotBaseFrame>base</robotBaseFrame><odometryRate>50</odometryRate>"
        "<cmdTimeout>0.5</cmdTimeout>"
    )
    assert (profile.namespace, profile.drive.command_topics, profile.drive.command_timeout) == (
        "r",
        ("go",),
        0.5,
    )
    odometry = profile.odometry
    assert (odometry.topic, odometry.frame, odometry.base_frame, odometry.rate) == (
        "where",
        "o",
        "base",
        50.0,
    )


def test_it_moves_at_once_in_the_commanded_direction():
    result = drive(scene_with(robot(), start=Pose2(yaw=math.pi / 2)), 1.0, Twist2(0.4, 0.0, 0.3))
    assert (result.base_in_world.x, result.base_in_world.y) == pytest.approx((-0.3, 0.4), abs=1e-3)
    assert result.base_in_world.yaw == pytest.approx(math.pi / 2, abs=1e-6)
    twist = result.odometry.twist
    assert (twist.v, twist.lateral, twist.omega) == pytest.approx((0.4, 0.3, 0.0), abs=1e-3)
    assert result.odometry.base_in_odom == result.base_in_world, "its odometry is the true pose in the world"


def test_it_turns_while_it_moves_sideways():
    """A circle of radius 0.5 m, on which it looks outwards."""
    result = drive(scene_with(robot()), 2.0 * math.pi, Twist2(0.0, 1.0, 0.5))
    assert (result.base_in_world.x, result.base_in_world.y) == pytest.approx((0.0, 0.0), abs=0.01)
    assert abs(result.base_in_world.yaw) == pytest.approx(0.0, abs=0.01)
    half = drive(scene_with(robot()), math.pi, Twist2(0.0, 1.0, 0.5))
    assert (half.base_in_world.x, half.base_in_world.y) == pytest.approx((-1.0, 0.0), abs=0.02)


def test_it_keeps_its_last_command_unless_there_is_a_timeout():
    for parameters, distance in (("", 1.0), ("<cmdTimeout>0.2</cmdTimeout>", 0.1)):
        scene = scene_with(robot(parameters))
        scene.step({"cart": Twist2(0.0, 0.0, 0.5)})
        assert drive(scene, 1.98).base_in_world.y == pytest.approx(distance, abs=0.015)


def test_it_stops_at_a_wall():
    result = drive(scene_with(robot(), WALL), 4.0, Twist2(0.5))
    assert result.base_in_world.x == pytest.approx(0.7, abs=0.02)
    assert result.contacts == ("wall::link",)
    assert result.tilt < 0.01


def test_it_pushes_what_stands_in_its_way():
    crate = (Collision(Box((0.2, 0.2, 0.2)), np.eye(4)),)
    scene = scene_with(robot(), Body("crate::link", pose3(0.6, 0.0, 0.1), crate, mass=1.0))
    drive(scene, 3.0, Twist2(0.3))
    assert scene.models.state("crate").pose[0, 3] == pytest.approx(0.9 + 0.25 + 0.1, abs=0.03)


def test_a_model_of_sdf_with_the_plugin_is_a_robot_and_its_z_is_that_of_the_floor():
    text = """<sdf version='1.6'><model name='any'><link name='base_footprint'><pose>0 0 0.1 0 0 0</pose>
    <inertial><mass>3</mass></inertial><collision name='c'>
    <geometry><box><size>0.4 0.4 0.2</size></box></geometry></collision></link>
    <plugin name='p' filename='libgazebo_ros_planar_move.so'/></model></sdf>"""
    (model,) = read_model(text, "cart", pose3(1.0, 2.0)).robots
    profile, base_in_world = read_sdf_robot(model)
    assert profile.drive.is_omnidirectional
    assert base_in_world[:3, 3] == pytest.approx([1.0, 2.0, 0.1])
    drive(scene_with(profile), 0.5, Twist2(0.0, 0.0, -0.4))
