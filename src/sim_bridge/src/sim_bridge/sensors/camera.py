"""Cameras for colour and depth, as Gazebo's camera and openni_kinect plugins have them."""

import math
from dataclasses import dataclass
from typing import Tuple

import numpy as np

from planar.config.settings import check
from sim_bridge.geometry.pose3 import inverse
from sim_bridge.views.rasterizer import Projection, draw

# From the frame that a camera looks along x of to the optical frame (REP 103): z ahead, x right, y down.
OPTICAL_IN_CAMERA = np.array(
    [[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0, 0, 0, 1.0]]
)


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
class Picture:
    """``rgb``: (H, W, 3), uint8; ``depth``: (H, W), float32, metres along the optical axis."""

    rgb: np.ndarray
    depth: np.ndarray


class Camera:
    """Takes pictures of triangles."""

    def __init__(self, settings: CameraSettings, rng: np.random.Generator):
        self.settings = settings
        self._rng = rng

    def measure(self, triangles_xyz: np.ndarray, shades: np.ndarray, camera_in_world: np.ndarray) -> Picture:
        """What is seen from ``camera_in_world``, (4, 4), along its x axis (see sim_bridge.views.drawing)."""
        world_in_optical = inverse(camera_in_world @ OPTICAL_IN_CAMERA)
        seen = triangles_xyz @ world_in_optical[:3, :3].T + world_in_optical[:3, 3]
        rgb, depth = draw(seen, shades, self.settings.projection())
        if self.settings.noise > 0.0:
            noisy = rgb + 255.0 * self._rng.normal(0.0, self.settings.noise, rgb.shape)
            rgb = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        return Picture(rgb, self._measured(depth))

    def _measured(self, depth: np.ndarray) -> np.ndarray:
        settings = self.settings
        if not isinstance(settings, DepthCameraSettings):
            return depth
        if settings.depth_noise > 0.0:
            sigma = settings.depth_noise * np.where(np.isfinite(depth), depth, 0.0) ** 2
            depth = depth + (sigma * self._rng.standard_normal(depth.shape, dtype=np.float32)).astype(
                np.float32
            )
        depth[(depth < settings.min_depth) | (depth > settings.max_depth)] = np.nan
        return depth


def points_of(depth: np.ndarray, settings: CameraSettings) -> np.ndarray:
    """The points (H, W, 3), float32, in the optical frame that a depth picture (H, W) shows."""
    (centre_x, centre_y), scale = settings.centre, settings.focal_length
    columns = (np.arange(settings.width, dtype=np.float32) - np.float32(centre_x)) / np.float32(scale)
    rows = (np.arange(settings.height, dtype=np.float32) - np.float32(centre_y)) / np.float32(scale)
    return np.stack((columns[None, :] * depth, rows[:, None] * depth, depth), axis=2)
