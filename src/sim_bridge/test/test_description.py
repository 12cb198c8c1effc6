"""Robots from URDF, xacro and SDF: their parts, and the drives and sensors of Gazebo plugins."""

import math
import os
import re

import numpy as np
import pytest

from sim_bridge import ROBOTS, RobotError, robot_named
from sim_bridge.description import read_sdf_robot, read_urdf_robot
from sim_bridge.description.bodies import bodies_of
from sim_bridge.errors import NoDriveError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.sdf import load_world
from sim_bridge.sensors.imu import ImuProfile
from sim_bridge.sensors.lidar import LaserProfile

BODY = """
<link name="chassis">
  <inertial><origin xyz="0 0 0.1"/><mass value="5"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>
  <collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.3 0.1"/></geometry></collision>
</link>"""
WHEEL = """
<link name="{side}">
  <inertial><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.001"/></inertial>
  <collision>
    <origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1" length="0.05"/></geometry>
  </collision>
</link>
<joint name="{side}_hinge" type="continuous">
  <parent link="chassis"/><child link="{side}"/><origin xyz="0 {y} 0.1"/><axis xyz="0 1 0"/>
</joint>"""
CASTER = """
<link name="caster"><collision><geometry><sphere radius="0.04"/></geometry></collision></link>
<joint name="swivel" type="continuous">
  <parent link="chassis"/><child link="caster"/><origin xyz="-0.15 0 0.041"/><axis xyz="0 0 1"/>
</joint>"""
DRIVE = """
<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so">
  <leftJoint>left_hinge</leftJoint><rightJoint>right_hinge</rightJoint>
  <wheelSeparation>0.4</wheelSeparation><wheelDiameter>0.2</wheelDiameter>{more}
</plugin></gazebo>"""
LASER = """
<link name="eye"/>
<joint name="eye_mount" type="fixed">
  <parent link="chassis"/><child link="eye"/><origin xyz="0.1 0 0.3" rpy="{roll} 0 0"/>
</joint>
<gazebo reference="eye"><sensor type="gpu_ray" name="s">
  <update_rate>20</update_rate>
  <ray><scan><horizontal><samples>181</samples><min_angle>-1.5</min_angle><max_angle>1.5</max_angle>
  </horizontal></scan><range><min>0.1</min><max>8</max></range>
  <noise><type>gaussian</type><stddev>0.02</stddev></noise></ray>
  <plugin name="p" filename="libgazebo_ros_gpu_laser.so">
    <topicName>/front/scan</topicName><frameName>eye</frameName>
  </plugin>
</sensor></gazebo>"""


def urdf(drive="", laser=""):
    wheels = WHEEL.format(side="left", y="0.2") + WHEEL.format(side="right", y="-0.2")
    return f"<robot name='mine'>{BODY}{wheels}{CASTER}{drive}{laser}</robot>"


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
def test_the_drive_of_a_profile_agrees_with_its_parts(robot):
    left, right = (robot.model.wheels[joint] for joint in robot.drive.joints)
    apart = left.origin_in_base[:3, 3] - right.origin_in_base[:3, 3]
    assert apart == pytest.approx([0.0, robot.drive.wheel_separation, 0.0])
    assert left.part.collisions[0].shape.radius == robot.drive.wheel_radius
    assert robot.warnings == ()


def test_fixed_parts_are_merged_into_the_base():
    base = robot_named("turtlebot_lidar").model.base
    assert base.mass == pytest.approx(2.4 + 0.01 + 0.01 + 1.0 + 0.2)
    assert np.abs(base.centre_of_mass[:2]).max() < 0.02
    assert len(base.collisions) == 5


def test_a_diff_drive_is_read_with_the_defaults_of_its_plugin():
    robot = read_urdf_robot(urdf(DRIVE.format(more="")), "mine.urdf")
    assert (robot.drive.left_joints, robot.drive.right_joints) == (("left_hinge",), ("right_hinge",))
    assert (robot.drive.wheel_radius, robot.drive.wheel_separation, robot.drive.torque) == (0.1, 0.4, 5.0)
    assert robot.drive.command_topics == ("cmd_vel",)
    assert math.isinf(robot.drive.command_timeout), "Gazebo's plugin keeps the last command"
    odometry = robot.odometry
    assert (odometry.source, odometry.topic, odometry.frame) == ("world", "odom", "odom")
    assert (odometry.base_frame, odometry.rate, odometry.sends_transform) == ("base_footprint", 100.0, True)
    assert odometry.variances == (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    assert robot.joint_states is None
    assert robot.model.lowest == pytest.approx(0.0, abs=1e-9)
    assert len(robot.model.base.collisions) == 2, "a caster is part of the base"


def test_parameters_of_a_diff_drive_are_read():
    more = """<robotNamespace>/r</robotNamespace><commandTopic>go</commandTopic>
    <odometryTopic>where</odometryTopic>
    <odometryFrame>o</odometryFrame><robotBaseFrame>chassis</robotBaseFrame><publishTf>false</publishTf>
    <odometrySource>encoder</odometrySource><updateRate>20</updateRate><wheelTorque>7</wheelTorque>
    <wheelAcceleration>1.5</wheelAcceleration><publishWheelJointState>true</publishWheelJointState>"""
    robot = read_urdf_robot(urdf(DRIVE.format(more=more)), "mine.urdf")
    assert (robot.namespace, robot.drive.command_topics, robot.drive.torque) == ("r", ("go",), 7.0)
    assert robot.drive.max_acceleration == 1.5
    assert robot.drive.max_turn_acceleration == pytest.approx(7.5)
    odometry = robot.odometry
    assert (odometry.source, odometry.topic, odometry.frame) == ("encoder", "where", "o")
    assert (odometry.base_frame, odometry.rate, odometry.sends_transform) == ("chassis", 20.0, False)
    assert robot.joint_states.joints == ("left_hinge", "right_hinge")


def test_wheels_are_assigned_to_sides_by_position_not_by_name():
    swapped = DRIVE.format(more="").replace("left", "?").replace("right", "left").replace("?", "right")
    swapped = swapped.replace("rightJoint", "?").replace("leftJoint", "rightJoint").replace("?", "leftJoint")
    drive = read_urdf_robot(urdf(swapped), "mine.urdf").drive
    assert (drive.left_joints, drive.right_joints) == (("left_hinge",), ("right_hinge",))


def test_parameters_of_a_laser_are_read():
    robot = read_urdf_robot(urdf(DRIVE.format(more=""), LASER.format(roll="0")), "mine.urdf")
    laser = robot.laser
    assert (laser.topic, laser.frame, laser.beams, laser.rate, laser.noise) == (
        "/front/scan", "eye", 181, 20.0, 0.02,
    )  # fmt: skip
    assert laser.angle_increment == pytest.approx(3.0 / 180)
    assert laser.pose_in_base[:3, 3] == pytest.approx([0.1, 0.0, 0.3])
    assert (laser.range_min, laser.range_max, laser.no_return) == (0.1, 8.0, math.inf)


def test_the_covariances_of_an_imu_follow_from_its_noise():
    imu = """<gazebo><plugin name="i" filename="libgazebo_ros_imu.so"><bodyName>chassis</bodyName>
    <topicName>imu/data</topicName><updateRate>50</updateRate><gaussianNoise>0.1</gaussianNoise></plugin></gazebo>"""
    (read,) = read_urdf_robot(urdf(DRIVE.format(more="") + imu), "mine.urdf").sensors_of(ImuProfile)
    assert (read.topic, read.frame, read.rate, read.noise) == ("imu/data", "chassis", 50.0, 0.1)
    assert read.angular_velocity_variances == read.orientation_variances == pytest.approx((0.01, 0.01, 0.01))


def test_an_unknown_plugin_gives_one_warning():
    unknown = "<gazebo><plugin name='{}' filename='libgazebo_ros_control.so'/></gazebo>"
    text = urdf(DRIVE.format(more="") + unknown.format(1) + unknown.format(2))
    assert read_urdf_robot(text, "mine.urdf").warnings == (
        "mine.urdf:31: robot 'mine' > gazebo > plugin '1' (libgazebo_ros_control.so): is not supported, "
        "ignored (and 1 more like it)",
        "mine.urdf:25: robot 'mine' > joint 'swivel': joint is fixed: only driven wheels turn",
    )


def test_driven_wheels_have_the_friction_of_their_description():
    grip = "<gazebo reference='left'><mu1>0.3</mu1><mu2>0.2</mu2><kp>1e6</kp></gazebo>"
    robot = read_urdf_robot(urdf(DRIVE.format(more=""), grip), "mine.urdf")
    wheels = robot.model.wheels
    assert (wheels["left_hinge"].friction, wheels["right_hinge"].friction) == (0.2, 1.0)
    surfaces = {body.name: body.surface.friction for body in bodies_of(robot.model, "r")[0]}
    assert surfaces == {"r::chassis": 0.0, "r::left": 0.2, "r::right": 1.0}
    assert len(robot.warnings) == 1, "the swivel joint alone"


def test_what_has_no_effect_in_a_description_is_named_with_its_line():
    grip = "\n<gazebo reference='chassis'>\n<mu1>0.3</mu1></gazebo>\n<sensors>2</sensors>"
    more = "<wheelSlip>1</wheelSlip>"
    warnings = read_urdf_robot(urdf(DRIVE.format(more=more), grip), "mine.urdf").warnings
    for place in ("gazebo > plugin 'd' > wheelSlip", "gazebo > mu1", "robot 'mine' > sensors"):
        (line,) = [text for text in warnings if f"{place}: has no effect" in text]
        assert re.match(r"mine.urdf:\d+: robot 'mine'", line)


def test_a_robot_without_a_drive_is_refused_naming_its_file(tmp_path):
    path = tmp_path / "mine.urdf"
    path.write_text(urdf())
    with pytest.raises(NoDriveError, match="mine.urdf: robot mine has no drive"):
        robot_named(str(path))


def test_a_xacro_file_becomes_a_robot_and_a_broken_one_an_error(tmp_path):
    path = tmp_path / "mine.urdf.xacro"
    macro = "<xacro:property name='wide' value='0.4'/>"
    drive = DRIVE.format(more="").replace(">0.4<", ">${wide}<")
    text = urdf(macro + drive).replace("<robot", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'")
    path.write_text(text)
    assert robot_named(str(path)).drive.wheel_separation == 0.4
    path.write_text(text.replace("${wide}", "${broad}"))
    with pytest.raises(RobotError, match="mine.urdf.xacro: not readable xacro .*broad"):
        robot_named(str(path))


def test_a_missing_mesh_is_ignored_with_a_warning():
    text = urdf(DRIVE.format(more="")).replace(
        '<box size="0.4 0.3 0.1"/>', "<mesh filename='package://nowhere/a.stl'/>"
    )
    robot = read_urdf_robot(text, "mine.urdf")
    assert robot.warnings[0].endswith("package://nowhere/a.stl not found, ignored")


def test_what_gazebo_ignores_gives_a_warning_and_the_robot_drives():
    sensor = '<sensor type="camera" name="eye"><plugin name="c" filename="libgazebo_ros_camera.so"/></sensor>'
    imu = '<plugin name="imu" filename="libgazebo_ros_imu.so"><bodyName>tail</bodyName></plugin>'
    parts = f'<gazebo reference="head">{sensor}</gazebo><gazebo>{imu}</gazebo>'
    text = urdf(DRIVE.format(more="<odometrySource>gps</odometrySource>") + parts)
    robot = read_urdf_robot(text, "mine.urdf")
    assert (robot.odometry.source, robot.sensors) == ("world", ())
    for named in (
        "<odometrySource> must be one of encoder, world, gyro, got 'gps'",
        "link 'head'",
        "link 'tail'",
    ):
        assert any(named in warning for warning in robot.warnings), named


def test_numbers_may_be_separated_by_commas_as_in_kinetics_urdfdom():
    text = urdf(DRIVE.format(more="")).replace('"0.4 0.3 0.1"', '"0.4, 0.3, 0.1"')
    assert read_urdf_robot(text, "mine.urdf").model.base.collisions[0].shape.size == (0.4, 0.3, 0.1)


def test_the_field_of_view_of_a_camera_is_limited():
    eye = LASER.format(roll=0).split("<gazebo")[0]
    camera = """<gazebo reference="eye"><sensor type="camera" name="c">
    <camera><horizontal_fov>3.183</horizontal_fov></camera>
    <plugin name="c" filename="libgazebo_ros_camera.so"/></sensor></gazebo>"""
    (found,) = read_urdf_robot(urdf(DRIVE.format(more=""), eye + camera), "mine.urdf").sensors
    assert found.settings.horizontal_fov == 3.0


def test_a_fixed_joint_needs_no_axis_and_a_box_may_have_no_thickness():
    text = urdf(DRIVE.format(more="")).replace('"0.4 0.3 0.1"', '"0.4 0 0.1"')
    held = text.replace('name="swivel" type="continuous"', 'name="swivel" type="fixed"')
    robot = read_urdf_robot(held.replace('xyz="0 0 1"', 'xyz="0 0 0"'), "mine.urdf")
    assert robot.model.base.collisions[0].shape.size == pytest.approx((0.4, 1e-4, 0.1))


def test_of_two_drives_the_one_with_missing_wheels_is_ignored():
    broken = DRIVE.format(more="").replace(">left_hinge", ">hinge")
    for drives in (DRIVE.format(more="") + broken, broken + DRIVE.format(more="")):
        robot = read_urdf_robot(urdf(drives), "mine.urdf")
        assert "left_hinge" in robot.drive.joints
        assert any("no joint 'hinge'" in warning and "ignored" in warning for warning in robot.warnings)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("<robot", "mine.urdf: not well-formed"),
        ("<model/>", "its root is <model>, expected <robot>"),
        ("<robot name='r'><link name='a'/><link name='b'/></robot>", "one root link, got a, b"),
        (urdf(DRIVE.format(more="")).replace('mass value="5"', 'mass value="0"'), "chassis: .* needs a mass"),
        (urdf(DRIVE.format(more="")).replace('mass value="5"', 'mass value="x"'), "mass: value: expected 1"),
        (urdf(DRIVE.format(more="")).replace('"0.4 0.3 0.1"', '"0.4 -1 0.1"'), "box: size must be positive"),
        (urdf(DRIVE.format(more="")).replace(">left_hinge", ">hinge"), "no joint 'hinge' .*left_hinge"),
        (urdf(DRIVE.format(more="").replace(">0.2<", ">-1<")), "wheelDiameter: must be positive"),
    ],
)
def test_a_description_that_is_not_valid_is_refused(text, named):
    with pytest.raises(RobotError, match=named):
        read_urdf_robot(text, "mine.urdf")


SDF_ROBOT = """<sdf version="1.4"><world name="w"><model name="rover"><pose>1 2 0.1 0 0 0.5</pose>
<link name="chassis"><pose>0 0 0.1 0 0 0</pose><inertial><mass>5</mass></inertial>
<collision name="c"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision>
<collision name="f"><pose>-0.15 0 -0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere>
</geometry></collision>
<sensor type="ray" name="s"><pose>0.2 0 0.1 0 0 0</pose>
<ray><scan><horizontal><samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></ray>
<plugin name="l" filename="libgazebo_ros_laser.so"><topicName>scan</topicName></plugin></sensor></link>
<link name="lw"><pose>0.1 0.13 0.1 0 1.5707 1.5707</pose><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder>
</geometry></collision></link>
<link name="rw"><pose>0.1 -0.13 0.1 0 1.5707 1.5707</pose><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder>
</geometry></collision></link>
<joint type="revolute" name="lj"><child>lw</child><parent>chassis</parent>
<axis><xyz>0 1 0</xyz></axis></joint>
<joint type="revolute" name="rj"><child>rw</child><parent>chassis</parent>
<axis><xyz>0 1 0</xyz></axis></joint>
<plugin name="d" filename="libgazebo_ros_diff_drive.so"><leftJoint>lj</leftJoint><rightJoint>rj</rightJoint>
<wheelSeparation>0.26</wheelSeparation><wheelDiameter>0.2</wheelDiameter></plugin>
</model></world></sdf>"""


def test_a_robot_without_a_laser_scans_with_its_depth_camera(tmp_path):
    laser = SDF_ROBOT[SDF_ROBOT.index("<sensor") : SDF_ROBOT.index("</sensor>")]
    kinect = """<sensor type="depth" name="k"><pose>0 0 0.3 0 0 0</pose><update_rate>20</update_rate>
<camera><horizontal_fov>1.0</horizontal_fov><image><width>101</width><height>80</height></image></camera>
<plugin name="k" filename="libgazebo_ros_openni_kinect.so"><updateRate>5</updateRate>
<frameName>camera_depth_optical_frame</frameName><pointCloudCutoffMax>4</pointCloudCutoffMax></plugin>"""
    path = tmp_path / "rover.world"
    path.write_text(SDF_ROBOT.replace(laser, kinect))
    (model,) = load_world(path).robots
    (scanner,) = read_sdf_robot(model)[0].sensors_of(LaserProfile)
    assert (scanner.frame, scanner.topic, scanner.rate) == ("camera_depth_frame", "scan", 5.0)
    assert (scanner.beams, scanner.angle_increment, scanner.sight) == (101, pytest.approx(0.01), 4.0)
    assert scanner.pose_in_base[2, 3] == pytest.approx(0.3)


def test_a_driven_model_of_a_world_is_read_as_a_robot(tmp_path):
    path = tmp_path / "rover.world"
    path.write_text(SDF_ROBOT)
    world = load_world(path)
    assert world.bodies == ()
    (model,) = world.robots
    robot, base_in_world = read_sdf_robot(model)
    assert (model.name, robot.name) == ("rover", "rover")
    assert base_in_world == pytest.approx(pose3(1.0, 2.0, 0.2, yaw=0.5))
    assert not world.warnings
    assert robot.drive.left_joints == ("lj",)
    wheel = robot.model.wheels["lj"]
    assert wheel.origin_in_base[:3, :3] @ wheel.axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-4)
    assert robot.laser.frame == "chassis"
    assert robot.laser.pose_in_base[:3, 3] == pytest.approx([0.2, 0.0, 0.1]), "seen from the chassis"


@pytest.mark.parametrize(
    "name", ["~nobody_of_that_name/x.urdf", "a\0b.urdf", "a" * 300 + ".urdf", "a" * 300 + ".xacro"]
)
def test_a_path_that_is_not_valid_is_refused(name):
    with pytest.raises(RobotError, match="cannot be read"):
        robot_named(name)


def test_a_named_pipe_is_refused_as_a_description(tmp_path):
    path = tmp_path / "robot.xacro"
    os.mkfifo(path)
    with pytest.raises(RobotError, match="cannot be read"):
        robot_named(str(path))
