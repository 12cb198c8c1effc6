"""Colour and depth cameras, as of Gazebo's camera and openni_kinect plugins."""

import math
from dataclasses import dataclass, replace
from typing import Any, Dict, Tuple

import numpy as np

from planar import SettingsError
from planar.config.settings import check
from sim_bridge.config import SimulationSettings
from sim_bridge.geometry.pose3 import inverse
from sim_bridge.sdf.values import number, text
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every
from sim_bridge.sensors.element import SensorElement
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.views.rasterizer import Projection, rasterize

STREAM = 100
# Pixels of a side at most.
MOST_PIXELS = 8192
# Optical frame (REP 103: z ahead, x right, y down) in a frame whose x axis points ahead.
OPTICAL_IN_CAMERA = np.array(
    [[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0, 0, 0, 1.0]]
)

# Widest field of view of a flat image [rad]; that of a fisheye lens is cut to it.
WIDEST = 3.0


@dataclass(frozen=True)
class CameraSettings:
    """Lens and noise of a camera.

    Attributes:
        width: Width of the image [pixels].
        height: Height of the image [pixels].
        horizontal_fov: Horizontal field of view [rad].
        near: Nearest visible depth [m].
        far: Farthest visible depth [m].
        noise: Standard deviation of colours, where 1 is full intensity.
    """

    width: int = 640
    height: int = 480
    horizontal_fov: float = math.radians(60.0)
    near: float = 0.05
    far: float = 100.0
    noise: float = 0.0

    def __post_init__(self):
        check(self.width > 0, "width", "positive", self.width)
        check(self.height > 0, "height", "positive", self.height)
        check(0.0 < self.horizontal_fov < math.pi, "horizontal_fov", "between 0 and pi", self.horizontal_fov)
        check(0.0 < self.near < self.far, "near", f"between 0 and far ({self.far:g})", self.near)
        check(self.noise >= 0.0, "noise", "not negative", self.noise)

    @property
    def focal_length(self) -> float:
        """Focal length [pixels]."""
        return self.width / 2.0 / math.tan(self.horizontal_fov / 2.0)

    @property
    def centre(self) -> Tuple[float, float]:
        """Principal point: column and row of the optical axis."""
        return ((self.width - 1) / 2.0, (self.height - 1) / 2.0)

    def projection(self) -> Projection:
        return Projection(self.width, self.height, self.focal_length, self.centre, self.near, self.far)


@dataclass(frozen=True)
class DepthCameraSettings(CameraSettings):
    """Lens and noise of a depth camera.

    Attributes:
        min_depth: Smaller depths are NaN (REP 118) [m].
        max_depth: Larger depths are NaN [m].
        depth_noise: Standard deviation at 1 m [m]; it grows with the square of the depth, as of a Kinect
            (Khoshelham and Elberink, Sensors 12, 2012).
    """

    min_depth: float = 0.4
    max_depth: float = 5.0
    depth_noise: float = 0.0

    def __post_init__(self):
        super().__post_init__()
        check(
            0.0 <= self.min_depth < self.max_depth,
            "min_depth",
            f"below max_depth ({self.max_depth:g})",
            self.min_depth,
        )
        check(self.depth_noise >= 0.0, "depth_noise", "not negative", self.depth_noise)


@dataclass(frozen=True, eq=False)
class CameraReading:
    """Images of a camera.

    Attributes:
        rgb: Colours (H, W, 3), uint8.
        depth: Depth along the optical axis (H, W), float32 [m].
    """

    rgb: np.ndarray
    depth: np.ndarray


@dataclass(frozen=True, eq=False)
class CameraProfile:
    """A camera of a robot's description.

    Attributes:
        frame: Optical frame of its images.
        pose_in_base: Pose (4, 4) in the base frame; the camera faces along its x axis.
        settings: Lens and noise.
        rate: Rate of the images [Hz].
        image_topic: Topic of colour images.
        info_topic: Topic of their camera info.
        depth_topic: Topic of depth images; empty for none.
        depth_info_topic: Topic of the camera info of depth images; empty for none.
        points_topic: Topic of point clouds; empty for none.
    """

    frame: str
    pose_in_base: np.ndarray
    settings: CameraSettings
    rate: float
    image_topic: str
    info_topic: str
    depth_topic: str = ""
    depth_info_topic: str = ""
    points_topic: str = ""

    def build(self, mounting: Mounting) -> "Camera":
        noise = mounting.settings
        settings = replace(self.settings, noise=noise.colour_noise)
        if isinstance(settings, DepthCameraSettings):
            settings = replace(settings, depth_noise=noise.depth_noise)
        return Camera(settings, mounting.rng(STREAM), self)


class Camera:
    """Renders images of the world's triangles.

    Args:
        settings: Lens and noise.
        rng: Random generator of the noise.
        profile: Frame, pose, rate and topics.
    """

    on_demand = True

    def __init__(self, settings: CameraSettings, rng: np.random.Generator, profile: CameraProfile):
        self.name, self.frame = profile.image_topic, profile.frame
        self._profile = profile
        self._settings = settings
        self._rng = rng

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(self._profile.rate, settings)

    def measure(self, context: SensorContext) -> CameraReading:
        """Render the world from the camera's pose on the robot."""
        return self.render(*context.triangles(), context.base.pose @ self._profile.pose_in_base)

    def render(
        self, triangles_xyz: np.ndarray, shades: np.ndarray, camera_in_world: np.ndarray
    ) -> CameraReading:
        """Render triangles.

        Args:
            triangles_xyz: Triangles (T, 3, 3) in the world [m].
            shades: Their shaded colours (T, 3), uint8.
            camera_in_world: Pose (4, 4) of the camera, which faces along its x axis.

        Returns:
            The images, with noise.
        """
        world_in_optical = inverse(camera_in_world @ OPTICAL_IN_CAMERA)
        in_optical = triangles_xyz @ world_in_optical[:3, :3].T + world_in_optical[:3, 3]
        rgb, depth = rasterize(in_optical, shades, self._settings.projection())
        if self._settings.noise > 0.0:
            noisy = rgb + 255.0 * self._rng.normal(0.0, self._settings.noise, rgb.shape)
            rgb = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        return CameraReading(rgb, self._measured(depth))

    def _measured(self, depth: np.ndarray) -> np.ndarray:
        settings = self._settings
        if not isinstance(settings, DepthCameraSettings):
            return depth
        if settings.depth_noise > 0.0:
            sigma = settings.depth_noise * np.where(np.isfinite(depth), depth, 0.0) ** 2
            depth = depth + (sigma * self._rng.standard_normal(depth.shape, dtype=np.float32)).astype(
                np.float32
            )
        depth[(depth < settings.min_depth) | (depth > settings.max_depth)] = np.nan
        return depth


def depth_to_points(depth: np.ndarray, settings: CameraSettings) -> np.ndarray:
    """Return the point cloud of a depth image.

    Args:
        depth: Depth image (H, W) [m].
        settings: Lens of the camera.

    Returns:
        Points (H, W, 3) in the optical frame, float32 [m].
    """
    (centre_x, centre_y), scale = settings.centre, settings.focal_length
    columns = (np.arange(settings.width, dtype=np.float32) - np.float32(centre_x)) / np.float32(scale)
    rows = (np.arange(settings.height, dtype=np.float32) - np.float32(centre_y)) / np.float32(scale)
    return np.stack((columns[None, :] * depth, rows[:, None] * depth, depth), axis=2)


def read_camera(element: SensorElement) -> CameraProfile:
    """Read a camera of Gazebo (gazebo_ros_camera).

    Raises:
        WorldError: A value is not valid.
    """
    values, topics = _values_of(element)
    try:
        settings = CameraSettings(**values)
    except SettingsError as error:
        raise element.sensor.error(str(error)) from None
    return CameraProfile(settings=settings, **topics)


def read_depth_camera(element: SensorElement) -> CameraProfile:
    """Read a depth camera of Gazebo (gazebo_ros_openni_kinect).

    Raises:
        WorldError: A value is not valid.
    """
    plugin, prefix = element.plugin, _prefix(element)
    values, topics = _values_of(element)
    try:
        settings = DepthCameraSettings(
            **values,
            min_depth=number(plugin, "pointCloudCutoff", 0.4),
            max_depth=number(plugin, "pointCloudCutoffMax", 5.0),
        )
    except SettingsError as error:
        raise element.sensor.error(str(error)) from None
    return CameraProfile(
        settings=settings,
        depth_topic=prefix + text(plugin, "depthImageTopicName", "depth/image_raw"),
        depth_info_topic=prefix + text(plugin, "depthImageCameraInfoTopicName", "depth/camera_info"),
        points_topic=prefix + text(plugin, "pointCloudTopicName", "points"),
        **topics,
    )


def _values_of(element: SensorElement) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """Read what all cameras have: values of CameraSettings, and the rest of their profile."""
    sensor, plugin, prefix = element.sensor, element.plugin, _prefix(element)
    camera = sensor.child("camera") or sensor
    values = {
        "width": camera.count("image", "width", most=MOST_PIXELS, default=640),
        "height": camera.count("image", "height", most=MOST_PIXELS, default=480),
        "horizontal_fov": min(camera.number("horizontal_fov", default=math.radians(60.0)), WIDEST),
        "near": camera.number("clip", "near", default=0.05),
        "far": camera.number("clip", "far", default=100.0),
    }
    topics = {
        "frame": text(plugin, "frameName", element.link),
        "pose_in_base": element.pose_in_base,
        "rate": number(plugin, "updateRate", 0.0) or element.update_rate or 10.0,
        "image_topic": prefix + text(plugin, "imageTopicName", "image_raw"),
        "info_topic": prefix + text(plugin, "cameraInfoTopicName", "camera_info"),
    }
    return values, topics


def _prefix(element: SensorElement) -> str:
    namespace = text(element.plugin, "cameraName", "").strip("/")
    return f"{namespace}/" if namespace else ""


def scan_of(camera: CameraProfile) -> LaserProfile:
    """Return the range finder that depthimage_to_laserscan makes of a depth camera, as on a TurtleBot.

    Its frame is named after the optical one: ``camera_depth_frame`` for ``camera_depth_optical_frame``.
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
