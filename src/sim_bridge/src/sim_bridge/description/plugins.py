"""Reads drives and sensors from Gazebo plugins, with the plugins' defaults (gazebo_plugins 2.9)."""

import math
from dataclasses import dataclass, field
from typing import Callable, Dict, List, Optional

import numpy as np

from sim_bridge.description.profile import JointStateProfile
from sim_bridge.description.structure import GazeboElements, RobotStructure
from sim_bridge.driving.drive import DriveProfile
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.power.battery import KOBUKI_BATTERY, TURTLEBOT3_BATTERY, BatteryProfile
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.supported import plugin_name
from sim_bridge.sdf.values import flag, length, number, text
from sim_bridge.sensors.base import SensorSpec
from sim_bridge.sensors.camera import CameraProfile, scan_of
from sim_bridge.sensors.dock_ir import DockIrProfile
from sim_bridge.sensors.element import SensorElement, namespace_of
from sim_bridge.sensors.imu import ImuProfile
from sim_bridge.sensors.kobuki import KobukiProfile
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.odometry import OdometryProfile
from sim_bridge.sensors.registry import BODY_SENSORS, SENSORS

ODOMETRY_SOURCES = ("encoder", "world", "gyro")
DEFAULT_SOURCE = "world"
# Plugins whose work is done here without them: ground truth is always published.
REDUNDANT_PLUGINS = {"gazebo_ros_p3d"}
UNSUPPORTED = "is not supported, ignored"
# Variances of z, roll and pitch, which odometry does not measure.
UNMEASURED = (1e12, 1e12, 1e12)
# Variances that Kobuki's plugin publishes for orientation and turn rates, about x, y and z.
KOBUKI_IMU_VARIANCES = (1e6, 1e6, 0.05)


@dataclass
class PluginProfiles:
    """Drive and sensors that the plugins of a robot define.

    Attributes:
        drive: The drive; None as long as no plugin of a drive has been read.
        odometry: The odometry, which the drive's plugin publishes.
        sensors: Specifications of the sensors.
        joint_states: Published joints, if any.
        namespace: Namespace of the drive's plugin.
        battery: The battery, if it is a robot's whose battery is known.
        warnings: A sentence for each kind of content that is ignored.
    """

    drive: Optional[DriveProfile] = None
    odometry: OdometryProfile = OdometryProfile()
    sensors: List[SensorSpec] = field(default_factory=list)
    joint_states: Optional[JointStateProfile] = None
    namespace: str = ""
    battery: Optional[BatteryProfile] = None
    warnings: List[str] = field(default_factory=list)


def read_plugins(structure: RobotStructure, elements: GazeboElements) -> PluginProfiles:
    """Read all plugins of a robot: drives first, since they define the namespace.

    A robot without a laser gets a scan from its depth camera (depthimage_to_laserscan).

    Args:
        structure: The link tree.
        elements: The <plugin> and <sensor> elements.

    Raises:
        WorldError: A value is not valid; the text names the element.
    """
    profiles = PluginProfiles()
    failed_drives = []
    for plugin in elements.plugins:
        reader = _PLUGINS.get(plugin_name(plugin))
        if reader is None:
            elements.skipped.skip(plugin, UNSUPPORTED)
            continue
        try:
            reader(plugin, structure, profiles)
        except WorldError as error:
            if reader not in _DRIVES.values():
                raise
            failed_drives.append(error)
    if failed_drives and profiles.drive is None:
        raise failed_drives[0]
    profiles.warnings += [f"{error}; ignored, as in Gazebo" for error in failed_drives]
    for link, sensor in elements.sensors:
        if link not in structure.links:
            elements.skipped.skip(sensor, f"there is no link {link!r}, ignored, as in Gazebo")
            continue
        if sensor.child("plugin") is None:
            elements.skipped.skip(sensor, "has no plugin, which would publish it")
        for plugin in sensor.children("plugin"):
            read = SENSORS.get(plugin_name(plugin))
            if read is not None:
                profiles.sensors.append(read(_found(plugin, sensor, link, structure, profiles)))
            else:
                elements.skipped.skip(sensor, f"plugin {plugin.attribute('filename')} {UNSUPPORTED}")
    if not any(isinstance(sensor, LaserProfile) for sensor in profiles.sensors):
        cameras = [sensor for sensor in profiles.sensors if isinstance(sensor, CameraProfile)]
        profiles.sensors += [scan_of(camera) for camera in cameras if camera.depth_topic][:1]
    return profiles


def _read_diff_drive(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    separation = length(plugin, "wheelSeparation", 0.34)
    acceleration = number(plugin, "wheelAcceleration", 0.0)
    joints = [text(plugin, "leftJoint", "left_joint"), text(plugin, "rightJoint", "right_joint")]
    profiles.namespace = namespace_of(plugin)
    if structure.name.startswith("turtlebot3"):
        profiles.battery = TURTLEBOT3_BATTERY
    profiles.drive = _drive(
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
    profiles.odometry = OdometryProfile(
        _odometry_source(plugin, profiles),
        text(plugin, "odometryTopic", "odom"),
        text(plugin, "odometryFrame", "odom"),
        text(plugin, "robotBaseFrame", "base_footprint"),
        sends_transform=flag(plugin, "publishTf", True) and flag(plugin, "publishOdomTF", True),
        rate=number(plugin, "updateRate", 100.0) or None,
        variances=(1e-5, 1e-5, *UNMEASURED, 1e-3),
    )
    if flag(plugin, "publishWheelJointState", False):
        profiles.joint_states = JointStateProfile(profiles.drive.joints, profiles.odometry.rate)


def _odometry_source(plugin: Element, profiles: PluginProfiles) -> str:
    """Return the odometry source; like Gazebo's plugin, replace an unknown one by the default."""
    source = text(plugin, "odometrySource", DEFAULT_SOURCE)
    if source in ODOMETRY_SOURCES:
        return source
    sources = ", ".join(ODOMETRY_SOURCES)
    profiles.warnings.append(
        f"{plugin.place}: <odometrySource> must be one of {sources}, got {source!r}; using {DEFAULT_SOURCE}"
    )
    return DEFAULT_SOURCE


def _read_skid_steer(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    sides = ("leftFront", "leftRear", "rightFront", "rightRear")
    defaults = ("left_front", "left_rear", "right_front", "right_rear")
    profiles.namespace = namespace_of(plugin)
    profiles.drive = _drive(
        plugin,
        structure,
        [text(plugin, f"{side}Joint", f"{name}_joint") for side, name in zip(sides, defaults)],
        wheel_radius=length(plugin, "wheelDiameter", 0.15) / 2.0,
        wheel_separation=length(plugin, "wheelSeparation", 0.4),
        torque=length(plugin, "torque", 5.0),
        command_topics=(text(plugin, "commandTopic", "cmd_vel"),),
    )
    profiles.odometry = OdometryProfile(
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


def _read_planar_move(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    """Read an omnidirectional drive, which moves the robot without wheels; a negative time-out is none."""
    timeout = number(plugin, "cmdTimeout", -1.0)
    profiles.namespace = namespace_of(plugin)
    profiles.drive = _drive(
        plugin,
        structure,
        [],
        wheel_radius=1.0,
        wheel_separation=2.0,
        torque=math.inf,
        command_topics=(text(plugin, "commandTopic", "cmd_vel"),),
        command_timeout=timeout if timeout >= 0.0 else math.inf,
    )
    rate: Optional[float] = number(plugin, "odometryRate", 20.0)
    if rate is not None and rate <= 0.0:
        rate = None
        profiles.warnings.append(
            f"{plugin.place}: <odometryRate> must be positive; using the rate of the simulation"
        )
    profiles.odometry = OdometryProfile(
        "world",
        text(plugin, "odometryTopic", "odom"),
        text(plugin, "odometryFrame", "odom"),
        text(plugin, "robotBaseFrame", "base_footprint"),
        rate=rate,
        variances=(1e-5, 1e-5, *UNMEASURED, 1e-3),
    )


def _read_kobuki(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    joints = [plugin.required(f"{side}_wheel_joint_name").text for side in ("left", "right")]
    profiles.battery = KOBUKI_BATTERY
    profiles.namespace = namespace_of(plugin)
    profiles.drive = _drive(
        plugin,
        structure,
        joints,
        wheel_radius=plugin.required("wheel_diameter").lengths(1)[0] / 2.0,
        wheel_separation=plugin.required("wheel_separation").lengths(1)[0],
        torque=plugin.required("torque").lengths(1)[0],
        command_topics=("mobile_base/commands/velocity", "cmd_vel"),
        command_timeout=plugin.required("velocity_command_timeout").lengths(1)[0],
    )
    profiles.odometry = OdometryProfile("gyro", sends_transform=plugin.flag("publish_tf"))
    profiles.joint_states = JointStateProfile(profiles.drive.joints)
    profiles.sensors.append(
        ImuProfile(
            "mobile_base/sensors/imu_data",
            "base_link",
            IDENTITY,
            orientation_variances=KOBUKI_IMU_VARIANCES,
            angular_velocity_variances=KOBUKI_IMU_VARIANCES,
        )
    )
    hubs = [structure.pose_in_base(structure.joints[name].child)[:3, 3] for name in profiles.drive.joints]
    threshold = length(plugin, "cliff_detection_threshold", 0.04)
    profiles.sensors.append(KobukiProfile(np.array(hubs), profiles.drive.wheel_radius, threshold))
    profiles.sensors.append(DockIrProfile())


def _read_joint_states(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    """Read the published joints; like Gazebo's plugin, fail on one that does not exist."""
    names = plugin.required("jointName").text.replace(",", " ").split()
    for name in names:
        if name not in structure.joints:
            raise plugin.error(f"<jointName>: the robot has no joint {name!r}")
    rate = number(plugin, "updateRate", 100.0) or None
    profiles.joint_states = JointStateProfile(tuple(names), rate)


def _read_body_sensor(plugin: Element, structure: RobotStructure, profiles: PluginProfiles) -> None:
    """Read a sensor plugin of the model, which names its link."""
    link = plugin.required("bodyName").text
    if link not in structure.links:
        profiles.warnings.append(f"{plugin.place}: <bodyName>: there is no link {link!r}, ignored")
        return
    found = SensorElement(plugin, plugin, link, structure.pose_in_base(link), profiles.namespace)
    profiles.sensors.append(SENSORS[plugin_name(plugin)](found))


def _found(
    plugin: Element, sensor: Element, link: str, structure: RobotStructure, profiles: PluginProfiles
) -> SensorElement:
    pose = sensor.raw_pose()
    in_base = structure.pose_in_base(link) @ (IDENTITY if pose is None else pose)
    return SensorElement(plugin, sensor, link, in_base, profiles.namespace)


# One that fails is ignored if another one drives the robot.
_DRIVES: Dict[str, Callable[[Element, RobotStructure, PluginProfiles], None]] = {
    "gazebo_ros_diff_drive": _read_diff_drive,
    "gazebo_ros_skid_steer_drive": _read_skid_steer,
    "gazebo_ros_kobuki": _read_kobuki,
    "gazebo_ros_planar_move": _read_planar_move,
}
_PLUGINS: Dict[str, Callable[[Element, RobotStructure, PluginProfiles], None]] = {
    **_DRIVES,
    "gazebo_ros_joint_state_publisher": _read_joint_states,
    **{name: _read_body_sensor for name in BODY_SENSORS},
    **{name: lambda *_: None for name in REDUNDANT_PLUGINS},
}


def _drive(plugin: Element, structure: RobotStructure, joints: List[str], **values) -> DriveProfile:
    """Return a drive; which wheels are on the left is decided by their positions.

    The plugins' names of the sides, and ``legacyMode``, are often wrong. Limits and a command time-out are
    extensions of the plugins' parameters.
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
