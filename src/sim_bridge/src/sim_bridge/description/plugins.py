"""Gazebo's plugins as drives and sensors, with the plugins' own defaults (gazebo_plugins 2.9)."""

import math
from dataclasses import dataclass, field
from typing import Callable, Dict, List, Optional

from sim_bridge.description.blocks import Blocks
from sim_bridge.description.profile import (
    CameraProfile,
    DriveProfile,
    ImuProfile,
    JointStateProfile,
    KobukiProfile,
    LaserProfile,
    OdometryProfile,
)
from sim_bridge.description.sensors import (
    CAMERA_PLUGINS,
    DEPTH_CAMERA_PLUGINS,
    IMU_PLUGINS,
    read_camera,
    read_imu,
    scan_of,
)
from sim_bridge.description.structure import Structure
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.plugins import plugin_name
from sim_bridge.sdf.values import flag, length, number, text

ODOMETRY_SOURCES = ("encoder", "world", "gyro")
LASER_PLUGINS = ("gazebo_ros_laser", "gazebo_ros_gpu_laser")
# They tell Gazebo what is true here anyhow.
NEEDLESS_PLUGINS = {"gazebo_ros_p3d"}
# Variances of z, roll and pitch that odometry does not measure.
UNMEASURED = (1e12, 1e12, 1e12)
# What Kobuki's plugin says of orientation and turn rates, about x, y and z.
KOBUKI_IMU_VARIANCES = (1e6, 1e6, 0.05)


@dataclass
class Equipment:
    """What the plugins of a robot add to its parts; ``namespace`` is that of the drive."""

    drive: Optional[DriveProfile] = None
    odometry: OdometryProfile = OdometryProfile()
    lasers: List[LaserProfile] = field(default_factory=list)
    cameras: List[CameraProfile] = field(default_factory=list)
    imus: List[ImuProfile] = field(default_factory=list)
    joint_states: Optional[JointStateProfile] = None
    kobuki: Optional[KobukiProfile] = None
    namespace: str = ""
    warnings: List[str] = field(default_factory=list)


def read_equipment(structure: Structure, blocks: Blocks) -> Equipment:
    """Drives first, as the namespace is theirs; a robot without a laser sees by its depth camera.

    Raises WorldError naming the element.
    """
    equipment = Equipment()
    left_out = []
    for plugin in blocks.plugins:
        reader = _PLUGINS.get(plugin_name(plugin))
        if reader is not None:
            reader(plugin, structure, equipment)
        else:
            left_out.append(plugin)
    for link, sensor in blocks.sensors:
        for plugin in sensor.children("plugin"):
            name = plugin_name(plugin)
            if name in LASER_PLUGINS:
                equipment.lasers.append(_read_laser(sensor, plugin, link, structure, equipment))
            elif name in CAMERA_PLUGINS + DEPTH_CAMERA_PLUGINS:
                is_depth = name in DEPTH_CAMERA_PLUGINS
                equipment.cameras.append(read_camera(sensor, plugin, link, structure, is_depth))
            elif name in IMU_PLUGINS:
                equipment.imus.append(read_imu(sensor, plugin, link, structure))
            else:
                left_out.append(plugin)
    if not equipment.lasers:
        equipment.lasers += [scan_of(camera) for camera in equipment.cameras if camera.depth_topic][:1]
    names = dict.fromkeys(plugin.attribute("filename") for plugin in left_out)
    equipment.warnings += [f"robot {structure.name}: plugin {name} is left out" for name in names]
    return equipment


def _read_diff_drive(plugin: Element, structure: Structure, equipment: Equipment) -> None:
    source = text(plugin, "odometrySource", "world")
    if source not in ODOMETRY_SOURCES:
        raise plugin.error(f"<odometrySource> must be one of {', '.join(ODOMETRY_SOURCES)}, got {source!r}")
    separation = length(plugin, "wheelSeparation", 0.34)
    acceleration = number(plugin, "wheelAcceleration", 0.0)
    joints = [text(plugin, "leftJoint", "left_joint"), text(plugin, "rightJoint", "right_joint")]
    equipment.namespace = _namespace(plugin)
    equipment.drive = _drive(
        plugin,
        structure,
        joints,
        wheel_radius=length(plugin, "wheelDiameter", 0.15) / 2.0,
        wheel_separation=separation,
        torque=length(plugin, "wheelTorque", 5.0),
        command_topics=(text(plugin, "commandTopic", "cmd_vel"),),
        max_acceleration=acceleration or math.inf,
        max_turn_acceleration=2.0 * acceleration / separation or math.inf,
    )
    equipment.odometry = OdometryProfile(
        source,
        text(plugin, "odometryTopic", "odom"),
        text(plugin, "odometryFrame", "odom"),
        text(plugin, "robotBaseFrame", "base_footprint"),
        sends_transform=flag(plugin, "publishTf", True) and flag(plugin, "publishOdomTF", True),
        rate=number(plugin, "updateRate", 100.0) or None,
        variances=(1e-5, 1e-5, *UNMEASURED, 1e-3),
    )
    if flag(plugin, "publishWheelJointState", False):
        equipment.joint_states = JointStateProfile(equipment.drive.joints, equipment.odometry.rate)


def _read_skid_steer(plugin: Element, structure: Structure, equipment: Equipment) -> None:
    sides = ("leftFront", "leftRear", "rightFront", "rightRear")
    defaults = ("left_front", "left_rear", "right_front", "right_rear")
    equipment.namespace = _namespace(plugin)
    equipment.drive = _drive(
        plugin,
        structure,
        [text(plugin, f"{side}Joint", f"{name}_joint") for side, name in zip(sides, defaults)],
        wheel_radius=length(plugin, "wheelDiameter", 0.15) / 2.0,
        wheel_separation=length(plugin, "wheelSeparation", 0.4),
        torque=length(plugin, "torque", 5.0),
        command_topics=(text(plugin, "commandTopic", "cmd_vel"),),
    )
    equipment.odometry = OdometryProfile(
        "world",
        text(plugin, "odometryTopic", "odom"),
        text(plugin, "odometryFrame", "odom"),
        text(plugin, "robotBaseFrame", "base_footprint"),
        sends_transform=flag(plugin, "broadcastTF", False),
        rate=number(plugin, "updateRate", 100.0) or None,
        variances=(
            number(plugin, "covariance_x", 1e-4),
            number(plugin, "covariance_y", 1e-4),
            *UNMEASURED,
            number(plugin, "covariance_yaw", 0.01),
        ),
    )


def _read_kobuki(plugin: Element, structure: Structure, equipment: Equipment) -> None:
    joints = [plugin.required(f"{side}_wheel_joint_name").text for side in ("left", "right")]
    equipment.namespace = _namespace(plugin)
    equipment.drive = _drive(
        plugin,
        structure,
        joints,
        wheel_radius=plugin.required("wheel_diameter").lengths(1)[0] / 2.0,
        wheel_separation=plugin.required("wheel_separation").lengths(1)[0],
        torque=plugin.required("torque").lengths(1)[0],
        command_topics=("mobile_base/commands/velocity", "cmd_vel"),
        command_timeout=plugin.required("velocity_command_timeout").lengths(1)[0],
    )
    equipment.odometry = OdometryProfile("gyro", sends_transform=plugin.flag("publish_tf"))
    equipment.joint_states = JointStateProfile(equipment.drive.joints)
    equipment.imus.append(
        ImuProfile(
            "mobile_base/sensors/imu_data",
            "base_link",
            IDENTITY,
            orientation_variances=KOBUKI_IMU_VARIANCES,
            turn_variances=KOBUKI_IMU_VARIANCES,
        )
    )
    equipment.kobuki = KobukiProfile(length(plugin, "cliff_detection_threshold", 0.04))


def _read_joint_states(plugin: Element, structure: Structure, equipment: Equipment) -> None:
    """Gazebo's plugin fails on a joint that is not there; so does this."""
    names = plugin.required("jointName").text.replace(",", " ").split()
    for name in names:
        if name not in structure.joints:
            raise plugin.error(f"<jointName>: the robot has no joint {name!r}")
    rate = number(plugin, "updateRate", 100.0) or None
    equipment.joint_states = JointStateProfile(tuple(names), rate)


def _read_laser(
    sensor: Element, plugin: Element, link: str, structure: Structure, equipment: Equipment
) -> LaserProfile:
    pose = sensor.raw_pose()
    ray = sensor.child("ray") or sensor.required("lidar")
    horizontal = ray.required("scan").required("horizontal")
    beams = int(horizontal.required("samples").lengths(1)[0])
    first, last = (horizontal.required(f"{end}_angle").numbers(1)[0] for end in ("min", "max"))
    span = ray.required("range")
    nearest, farthest = span.required("min").numbers(1)[0], span.required("max").lengths(1)[0]
    if beams < 2 or last <= first or not 0.0 <= nearest < farthest:
        raise sensor.error("a range finder needs two samples, min_angle < max_angle and 0 <= min < max range")
    deviation = ray.child("noise", "stddev")
    rate = number(sensor, "update_rate", 0.0)
    return LaserProfile(
        frame=text(plugin, "frameName", link),
        topic=_topic(plugin, "topicName", "scan", equipment.namespace),
        pose_in_base=structure.pose_in_base(link) @ (IDENTITY if pose is None else pose),
        beams=beams,
        angle_min=first,
        angle_increment=(last - first) / (beams - 1),
        range_min=nearest,
        range_max=farthest,
        sight=farthest,
        rate=rate or None,
        noise=deviation.numbers(1)[0] if deviation is not None else None,
    )


def _read_imu(plugin: Element, structure: Structure, equipment: Equipment) -> None:
    """A plugin below the model that names its link."""
    equipment.imus.append(read_imu(None, plugin, plugin.required("bodyName").text, structure))


_PLUGINS: Dict[str, Callable[[Element, Structure, Equipment], None]] = {
    "gazebo_ros_diff_drive": _read_diff_drive,
    "gazebo_ros_skid_steer_drive": _read_skid_steer,
    "gazebo_ros_kobuki": _read_kobuki,
    "gazebo_ros_joint_state_publisher": _read_joint_states,
    **{name: _read_imu for name in IMU_PLUGINS},
    **{name: lambda *_: None for name in NEEDLESS_PLUGINS},
}


def _drive(plugin: Element, structure: Structure, joints: List[str], **values) -> DriveProfile:
    """A drive; which wheel is on which side, its place says: names and ``legacyMode`` often say otherwise.

    What Gazebo's plugins cannot say, ours may: limits and a time-out.
    """
    for name in joints:
        if name not in structure.joints:
            raise plugin.error(f"the robot has no joint {name!r} (joints: {', '.join(structure.joints)})")
    left = [name for name in joints if structure.pose_in_base(structure.joints[name].child)[1, 3] > 0.0]
    for tag, key in (
        ("maxSpeed", "max_speed"),
        ("maxTurnRate", "max_turn_rate"),
        ("maxAcceleration", "max_acceleration"),
        ("maxTurnAcceleration", "max_turn_acceleration"),
        ("commandTimeout", "command_timeout"),
    ):
        if plugin.child(tag) is not None:
            values[key] = length(plugin, tag, math.inf)
    return DriveProfile(tuple(left), tuple(name for name in joints if name not in left), **values)


def _namespace(plugin: Element) -> str:
    return text(plugin, "robotNamespace", "").strip("/")


def _topic(plugin: Element, tag: str, default: str, robots_namespace: str) -> str:
    """A topic; absolute if the plugin has another namespace than its robot."""
    topic, namespace = text(plugin, tag, default), _namespace(plugin)
    if topic.startswith("/") or namespace in ("", robots_namespace):
        return topic
    return f"/{namespace}/{topic}"
