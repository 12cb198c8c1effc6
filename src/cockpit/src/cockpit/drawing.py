"""Shapes that layers draw, as arrays, and the update that a layer returns."""

from dataclasses import dataclass, field
from typing import Optional, Tuple, Union

import numpy as np

from planar.deprecation import deprecated_names

Colour = Tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class PointCloudShape:
    """A point cloud.

    Attributes:
        points: Points (N, 3) [m].
        colours: Colours (N, 3), uint8, or one colour for all.
        size: Diameter of a point [m].
    """

    points: np.ndarray
    colours: Union[np.ndarray, Colour]
    size: float = 0.04


@dataclass(frozen=True, eq=False)
class LineSegments:
    """Line segments.

    Attributes:
        segments: Ends (N, 2, 3) of the segments [m].
        colours: Colours (N, 2, 3) of the ends, uint8, or one colour for all.
        width: Line width [pixels].
    """

    segments: np.ndarray
    colours: Union[np.ndarray, Colour]
    width: float = 3.0


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A triangle mesh.

    Attributes:
        vertices: Vertices (N, 3) [m].
        triangles: Vertex indices (M, 3).
        colour: Colour of the mesh.
        opacity: Opacity, 0 to 1.
        is_smooth: Whether normals are interpolated.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    colour: Colour
    opacity: float = 1.0
    is_smooth: bool = False


@dataclass(frozen=True, eq=False)
class FloorImage:
    """An image that lies in the xy plane.

    Attributes:
        picture: Image (rows, columns, 4), uint8, the first row at the top.
        width: Size along x [m].
        height: Size along y [m].
        pose: Pose (4, 4) of the lower left corner.
    """

    picture: np.ndarray
    width: float
    height: float
    pose: np.ndarray


@dataclass(frozen=True, eq=False)
class Label:
    """A text at a position.

    Attributes:
        text: The text.
        position: Position (3,) [m].
    """

    text: str
    position: np.ndarray


@dataclass(frozen=True, eq=False)
class FrameAxes:
    """Coordinate axes.

    Attributes:
        poses: Poses (N, 4, 4) of the axes.
        length: Length of each axis [m].
    """

    poses: np.ndarray
    length: float = 0.3


@dataclass(frozen=True, eq=False)
class CameraImage:
    """A camera image, shown in a window beside the world.

    Attributes:
        picture: Image (rows, columns, 3), uint8.
    """

    picture: np.ndarray


Drawable = Union[PointCloudShape, LineSegments, TriangleMesh, FloorImage, Label, FrameAxes, CameraImage]


@dataclass(frozen=True, eq=False)
class PlacedShape:
    """A shape in a frame. A shape of the same name in the same layer is replaced.

    Attributes:
        name: Name within the layer.
        frame: Frame id.
        shape: The shape to draw.
        pose: Pose (4, 4) of the shape in the frame; None for the identity.
        seconds: Lifetime [s].
        stamp: ROS time at which the frame's pose is taken [s]; None to follow the frame.
    """

    name: str
    frame: str
    shape: Drawable
    pose: Optional[np.ndarray] = None
    seconds: float = np.inf
    stamp: Optional[float] = None


@dataclass(frozen=True, eq=False)
class LayerUpdate:
    """A change of what a layer shows.

    Attributes:
        parts: New or replaced shapes.
        keeps: Whether shapes that are not listed stay.
        gone: Names of removed shapes; "*" removes all earlier ones.
        warning: What cannot be drawn, and why.
    """

    parts: Tuple[PlacedShape, ...] = ()
    keeps: bool = False
    gone: Tuple[str, ...] = ()
    warning: str = field(default="")


__getattr__ = deprecated_names(
    __name__,
    {
        "Points": "PointCloudShape",
        "Lines": "LineSegments",
        "Surface": "TriangleMesh",
        "Floor": "FloorImage",
        "Axes": "FrameAxes",
        "Screen": "CameraImage",
        "Part": "PlacedShape",
        "Drawing": "LayerUpdate",
    },
)
