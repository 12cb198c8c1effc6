"""Markers and marker arrays: all types of visualization_msgs except mesh resources."""

from typing import Callable, Dict, List, Tuple

import numpy as np

from cockpit.drawing import (
    Drawable,
    Label,
    LayerUpdate,
    LineSegments,
    PlacedShape,
    PointCloudShape,
    TriangleMesh,
)
from cockpit.frames import pose_matrix
from cockpit.layer import DisplayLayer
from cockpit.models.solids import ball, box, cylinder, placed_at

ADD, DELETE, DELETE_ALL = 0, 2, 3
ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST = range(6)
CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES = range(6, 12)
HAIRLINE, BLACK = 2.0, (30, 30, 30)
# Line widths are drawn in pixels so that lines stay visible from afar; pixels per metre of width.
PIXELS_PER_METRE = 60.0
MOST_SOLIDS = 2000


class MarkerLayer:
    """Draws markers; each replaces the marker of the same namespace and id."""

    def __call__(self, message) -> LayerUpdate:
        parts: Dict[str, PlacedShape] = {}
        gone: List[str] = []
        warning = ""
        for marker in getattr(message, "markers", None) or ([message] if hasattr(message, "ns") else []):
            name = f"{marker.ns}:{marker.id}"
            if marker.action == DELETE_ALL:
                parts.clear()
                gone = ["*"]
            elif marker.action == DELETE:
                parts.pop(name, None)
                gone.append(name)
            elif marker.action == ADD:
                try:
                    parts[name] = part_of(marker, name)
                except ValueError as error:
                    warning = f"marker {name}: {error}"
        return LayerUpdate(tuple(parts.values()), keeps=True, gone=tuple(gone), warning=warning)


def part_of(marker, name: str) -> PlacedShape:
    """Convert a marker.

    Args:
        marker: visualization_msgs/Marker.
        name: Name of the shape.

    Raises:
        ValueError: The marker is malformed.
    """
    p, q = marker.pose.position, marker.pose.orientation
    quaternion = (q.x, q.y, q.z, q.w) if any((q.x, q.y, q.z, q.w)) else (0.0, 0.0, 0.0, 1.0)
    pose = pose_matrix((p.x, p.y, p.z), quaternion)
    scale = np.array([marker.scale.x, marker.scale.y, marker.scale.z])
    points = np.array([(point.x, point.y, point.z) for point in marker.points], dtype=float).reshape(-1, 3)
    if pose is None or not np.isfinite(scale).all() or not np.isfinite(points).all():
        raise ValueError("its pose, scale or a point is not finite")
    draw = _KINDS.get(marker.type)
    if draw is None:
        raise ValueError(f"its type {marker.type} cannot be shown")
    seconds = marker.lifetime.to_sec()
    shape = draw(marker, np.abs(scale), points)
    return PlacedShape(name, marker.header.frame_id, shape, pose, seconds if seconds > 0.0 else np.inf)


def _colour(warning) -> Tuple[int, int, int]:
    red, green, blue = (
        int(np.clip(np.nan_to_num(part), 0.0, 1.0) * 255) for part in (warning.r, warning.g, warning.b)
    )
    return red, green, blue


def _colours(marker, count: int) -> np.ndarray:
    """Return the colours (count, 3): per point, or the marker's colour for all."""
    if len(marker.colors) == count and count:
        return np.array([_colour(colour) for colour in marker.colors], np.uint8)
    return np.tile(np.array(_colour(marker.color), np.uint8), (count, 1))


def _solid(shape: Callable[[], Tuple[np.ndarray, np.ndarray]]):
    def draw(marker, scale: np.ndarray, _points: np.ndarray) -> Drawable:
        vertices, triangles = shape()
        return TriangleMesh(vertices * scale, triangles, _colour(marker.color), _opacity(marker))

    return draw


def _solids(shape: Callable[[], Tuple[np.ndarray, np.ndarray]]):
    def draw(marker, scale: np.ndarray, points: np.ndarray) -> Drawable:
        vertices, triangles = shape()
        vertices, triangles = placed_at(vertices * scale, triangles, points[:MOST_SOLIDS])
        return TriangleMesh(vertices, triangles, _colour(marker.color), _opacity(marker))

    return draw


def _opacity(marker) -> float:
    return float(np.clip(np.nan_to_num(marker.color.a), 0.0, 1.0))


def _arrow(marker, scale: np.ndarray, points: np.ndarray) -> Drawable:
    """Draw an arrow from the first to the second point, or along x with the length of its scale."""
    start, end = (points[0], points[1]) if len(points) >= 2 else (np.zeros(3), np.array([scale[0], 0.0, 0.0]))
    along = end - start
    across = np.cross(along, (0.0, 0.0, 1.0)) if np.abs(along[:2]).max(initial=0.0) > 1e-9 else np.zeros(3)
    head = 0.3 * along
    ends = [start, end - head + 0.2 * across, end - head - 0.2 * across]
    segments = np.array([(point, end) for point in ends])
    return LineSegments(segments, _colour(marker.color), max(PIXELS_PER_METRE * float(scale[1]), HAIRLINE))


def _lines(is_strip: bool):
    def draw(marker, scale: np.ndarray, points: np.ndarray) -> Drawable:
        colours = _colours(marker, len(points))
        if is_strip:
            ends = np.column_stack((np.arange(len(points) - 1), np.arange(1, len(points)))).astype(int)
        else:
            ends = np.arange(len(points) // 2 * 2).reshape(-1, 2)
        width = max(PIXELS_PER_METRE * float(scale[0]), HAIRLINE)
        return LineSegments(points[ends].reshape(-1, 2, 3), colours[ends].reshape(-1, 2, 3), width)

    return draw


def _points(marker, scale: np.ndarray, points: np.ndarray) -> Drawable:
    return PointCloudShape(points, _colours(marker, len(points)), max(float(scale[0]), 0.01))


def _text(marker, _scale: np.ndarray, _points: np.ndarray) -> Drawable:
    return Label(str(marker.text)[:200], np.zeros(3))


def _triangles(marker, scale: np.ndarray, points: np.ndarray) -> Drawable:
    count = len(points) // 3
    return TriangleMesh(
        points[: 3 * count] * scale,
        np.arange(3 * count).reshape(-1, 3),
        _colour(marker.color),
        _opacity(marker),
    )


_KINDS: Dict[int, Callable[..., Drawable]] = {
    ARROW: _arrow,
    CUBE: _solid(box),
    SPHERE: _solid(ball),
    CYLINDER: _solid(cylinder),
    LINE_STRIP: _lines(is_strip=True),
    LINE_LIST: _lines(is_strip=False),
    CUBE_LIST: _solids(box),
    SPHERE_LIST: _solids(ball),
    POINTS: _points,
    TEXT: _text,
    TRIANGLES: _triangles,
}
LAYER = DisplayLayer(
    "Markers",
    ("visualization_msgs/Marker", "visualization_msgs/MarkerArray"),
    MarkerLayer,
    shown=("visualization_marker", "visualization_marker_array", "markers", "frontiers", "zones"),
    needs_all=True,
)
