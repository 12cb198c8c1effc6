"""Cameras for colour and depth, as Gazebo's camera and openni_kinect plugins have them."""

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
# Of a side.
MOST_PIXELS = 8192
# From the frame that a camera looks along x of to the optical frame (REP 103): z ahead, x right, y down.
OPTICAL_IN_CAMERA = np.array(
    [[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0, 0, 0, 1.0]]
)

# Radians that a flat picture can hold; fish eyes of descriptions see more.
WIDEST = 3.0


@dataclass(frozen=True)
class CameraSettings:
    """``horizontal_fov`` in rad, ``near``, ``far`` in m, ``noise``: standard deviation of colour, 0 to 1."""

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
        """Pixels."""
        return self.width / 2.0 / math.tan(self.horizontal_fov / 2.0)

    @property
    def centre(self) -> Tuple[float, float]:
        """Column and row of the optical axis."""
        return ((self.width - 1) / 2.0, (self.height - 1) / 2.0)

    def projection(self) -> Projection:
        return Projection(self.width, self.height, self.focal_length, self.centre, self.near, self.far)


@dataclass(frozen=True)
class DepthCameraSettings(CameraSettings):
    """Depths outside ``min_depth`` to ``max_depth``, m, read NaN (REP 118).

    ``depth_noise``: standard deviation, m, at 1 m; it grows with the square of the depth, as a Kinect's does
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
class CameraImage:
    """``rgb``: (H, W, 3), uint8; ``depth``: (H, W), float32, metres along the optical axis."""

    rgb: np.ndarray
    depth: np.ndarray


@dataclass(frozen=True, eq=False)
class CameraProfile:
    """A camera that looks along x of ``pose_in_base`` (4, 4), ``rate`` times a second.

    ``frame`` is the optical one. Topics of the colour picture and, if it measures depth, of the depth picture
    and the points; a topic that is empty is not there.
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
    """Takes pictures of triangles."""

    on_demand = True

    def __init__(self, settings: CameraSettings, rng: np.random.Generator, profile: CameraProfile):
        self.name, self.frame = profile.image_topic, profile.frame
        self._profile = profile
        self._settings = settings
        self._rng = rng

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(self._profile.rate, settings)

    def measure(self, context: SensorContext) -> CameraImage:
        """What is seen along the x axis of the camera's place on the robot."""
        return self.render(*context.triangles(), context.base.pose @ self._profile.pose_in_base)

    def render(
        self, triangles_xyz: np.ndarray, shades: np.ndarray, camera_in_world: np.ndarray
    ) -> CameraImage:
        """Render triangles (see sim_bridge.views.drawing).

        Args:
            triangles_xyz: (T, 3, 3), in the world [m].
            shades: (T, 3), uint8.
            camera_in_world: (4, 4); the camera faces along its x axis.
        """
        world_in_optical = inverse(camera_in_world @ OPTICAL_IN_CAMERA)
        seen = triangles_xyz @ world_in_optical[:3, :3].T + world_in_optical[:3, 3]
        rgb, depth = rasterize(seen, shades, self._settings.projection())
        if self._settings.noise > 0.0:
            noisy = rgb + 255.0 * self._rng.normal(0.0, self._settings.noise, rgb.shape)
            rgb = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        return CameraImage(rgb, self._measured(depth))

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
    """The points (H, W, 3), float32, in the optical frame that a depth picture (H, W) shows."""
    (centre_x, centre_y), scale = settings.centre, settings.focal_length
    columns = (np.arange(settings.width, dtype=np.float32) - np.float32(centre_x)) / np.float32(scale)
    rows = (np.arange(settings.height, dtype=np.float32) - np.float32(centre_y)) / np.float32(scale)
    return np.stack((columns[None, :] * depth, rows[:, None] * depth, depth), axis=2)


def read_camera(found: SensorElement) -> CameraProfile:
    """Of gazebo_ros_camera. Raises WorldError."""
    values, topics = _values_of(found)
    try:
        settings = CameraSettings(**values)
    except SettingsError as error:
        raise found.sensor.error(str(error)) from None
    return CameraProfile(settings=settings, **topics)


def read_depth_camera(found: SensorElement) -> CameraProfile:
    """Of gazebo_ros_openni_kinect. Raises WorldError."""
    plugin, prefix = found.plugin, _prefix(found)
    values, topics = _values_of(found)
    try:
        settings = DepthCameraSettings(
            **values,
            min_depth=number(plugin, "pointCloudCutoff", 0.4),
            max_depth=number(plugin, "pointCloudCutoffMax", 5.0),
        )
    except SettingsError as error:
        raise found.sensor.error(str(error)) from None
    return CameraProfile(
        settings=settings,
        depth_topic=prefix + text(plugin, "depthImageTopicName", "depth/image_raw"),
        depth_info_topic=prefix + text(plugin, "depthImageCameraInfoTopicName", "depth/camera_info"),
        points_topic=prefix + text(plugin, "pointCloudTopicName", "points"),
        **topics,
    )


def _values_of(found: SensorElement) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """What all cameras say: values of CameraSettings, and the rest of their profile."""
    sensor, plugin, prefix = found.sensor, found.plugin, _prefix(found)
    camera = sensor.child("camera") or sensor
    values = {
        "width": camera.count("image", "width", most=MOST_PIXELS, default=640),
        "height": camera.count("image", "height", most=MOST_PIXELS, default=480),
        "horizontal_fov": min(camera.number("horizontal_fov", default=math.radians(60.0)), WIDEST),
        "near": camera.number("clip", "near", default=0.05),
        "far": camera.number("clip", "far", default=100.0),
    }
    topics = {
        "frame": text(plugin, "frameName", found.link),
        "pose_in_base": found.pose_in_base,
        "rate": number(plugin, "updateRate", 0.0) or found.update_rate or 10.0,
        "image_topic": prefix + text(plugin, "imageTopicName", "image_raw"),
        "info_topic": prefix + text(plugin, "cameraInfoTopicName", "camera_info"),
    }
    return values, topics


def _prefix(found: SensorElement) -> str:
    namespace = text(found.plugin, "cameraName", "").strip("/")
    return f"{namespace}/" if namespace else ""


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
