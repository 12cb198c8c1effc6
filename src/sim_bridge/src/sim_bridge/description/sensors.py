"""Gazebo's plugins of cameras and inertial sensors (gazebo_plugins 2.9)."""

import math
from typing import Any, Dict, Optional

from planar import SettingsError
from sim_bridge.description.profile import CameraProfile, ImuProfile, LaserProfile
from sim_bridge.description.structure import Structure
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.values import number, text
from sim_bridge.sensors.camera import CameraSettings, DepthCameraSettings

CAMERA_PLUGINS = ("gazebo_ros_camera", "gazebo_ros_multicamera")
DEPTH_CAMERA_PLUGINS = ("gazebo_ros_openni_kinect", "gazebo_ros_depth_camera")
IMU_PLUGINS = ("gazebo_ros_imu_sensor", "gazebo_ros_imu", "hector_gazebo_ros_imu")


def read_camera(
    sensor: Element, plugin: Element, link: str, structure: Structure, is_depth: bool
) -> CameraProfile:
    """A camera's sensor and plugin. Raises WorldError."""
    camera, pose = sensor.child("camera") or sensor, sensor.raw_pose()
    values: Dict[str, Any] = {
        "width": int(camera.number("image", "width", default=640.0)),
        "height": int(camera.number("image", "height", default=480.0)),
        "horizontal_fov": camera.number("horizontal_fov", default=math.radians(60.0)),
        "near": camera.number("clip", "near", default=0.05),
        "far": camera.number("clip", "far", default=100.0),
    }
    namespace = text(plugin, "cameraName", "").strip("/")
    prefix = f"{namespace}/" if namespace else ""
    if is_depth:
        values["min_depth"] = number(plugin, "pointCloudCutoff", 0.4)
        values["max_depth"] = number(plugin, "pointCloudCutoffMax", 5.0)
    try:
        settings = DepthCameraSettings(**values) if is_depth else CameraSettings(**values)
    except SettingsError as error:
        raise sensor.error(str(error)) from None
    return CameraProfile(
        frame=text(plugin, "frameName", link),
        pose_in_base=structure.pose_in_base(link) @ (IDENTITY if pose is None else pose),
        settings=settings,
        rate=number(plugin, "updateRate", 0.0) or number(sensor, "update_rate", 0.0) or 10.0,
        image_topic=prefix + text(plugin, "imageTopicName", "image_raw"),
        info_topic=prefix + text(plugin, "cameraInfoTopicName", "camera_info"),
        depth_topic=prefix + text(plugin, "depthImageTopicName", "depth/image_raw") if is_depth else "",
        depth_info_topic=(
            prefix + text(plugin, "depthImageCameraInfoTopicName", "depth/camera_info") if is_depth else ""
        ),
        points_topic=prefix + text(plugin, "pointCloudTopicName", "points") if is_depth else "",
    )


def scan_of(camera: CameraProfile) -> LaserProfile:
    """The level scan that depthimage_to_laserscan makes of a depth camera, with a TurtleBot's defaults.

    Its frame is beside the optical one and named after it: ``camera_depth_frame`` for
    ``camera_depth_optical_frame``.
    """
    settings = camera.settings
    assert isinstance(settings, DepthCameraSettings)
    return LaserProfile(
        frame=camera.frame.replace("_optical", ""),
        topic="scan",
        pose_in_base=camera.pose_in_base,
        beams=settings.width,
        angle_min=-settings.horizontal_fov / 2.0,
        angle_increment=settings.horizontal_fov / (settings.width - 1),
        range_min=0.45,
        range_max=10.0,
        sight=settings.max_depth,
        no_return=math.nan,
        too_near=math.nan,
        scan_time=0.033,
        rate=camera.rate,
    )


def read_imu(sensor: Optional[Element], plugin: Element, link: str, structure: Structure) -> ImuProfile:
    """An inertial sensor's plugin, in a <sensor> or below the model. Raises WorldError."""
    pose = sensor.raw_pose() if sensor is not None else None
    noise = plugin.child("gaussianNoise")
    deviation = noise.numbers(1)[0] if noise is not None else None
    variances = ((deviation or 0.0) ** 2,) * 3
    return ImuProfile(
        topic=text(plugin, "topicName", "imu"),
        frame=text(plugin, "frameName", "") or text(plugin, "frameId", "") or link,
        pose_in_base=structure.pose_in_base(link) @ (IDENTITY if pose is None else pose),
        rate=number(plugin, "updateRateHZ", 0.0) or number(plugin, "updateRate", 0.0) or None,
        noise=deviation,
        orientation_variances=variances,
        turn_variances=variances,
        acceleration_variances=variances,
    )
