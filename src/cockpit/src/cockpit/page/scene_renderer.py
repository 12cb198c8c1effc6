"""Draws the shapes of layers into the scene and keeps them at their frames."""

import hashlib
from dataclasses import dataclass
from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np
import viser.transforms

from cockpit.drawing import (
    FloorImage,
    FrameAxes,
    Label,
    LayerUpdate,
    LineSegments,
    PlacedShape,
    PointCloudShape,
    TriangleMesh,
)
from cockpit.frames import FrameTree, wxyz_of

STILL = 1e-6
EVERYTHING = "*"
# Images of viser lie in the plane of a camera: x to the right, y down.
LAID_DOWN = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass
class _SceneNode:
    """A shape in the scene: ``node`` carries the pose last sent, ``shape`` is its child."""

    part: PlacedShape
    node: Any
    shape: Any
    pose: Optional[np.ndarray] = None
    digest: bytes = b""
    ends: float = np.inf


class SceneRenderer:
    """Keeps the shapes of all layers in the scene.

    Args:
        scene: The scene of viser.
    """

    def __init__(self, scene):
        self._scene = scene
        self._shown: Dict[Tuple[str, str], _SceneNode] = {}

    def show(self, layer: str, update: LayerUpdate, now: float = 0.0) -> None:
        """Apply an update of a layer.

        Args:
            layer: Name of the layer.
            update: New and removed shapes.
            now: Steady-clock time, from which lifetimes count [s].
        """
        names = {part.name for part in update.parts}
        for key in list(self._shown):
            if (
                key[0] == layer
                and key[1] not in names
                and (not update.keeps or EVERYTHING in update.gone or key[1] in update.gone)
            ):
                self._remove(key)
        for part in update.parts:
            self._put((layer, part.name), part)
            self._shown[layer, part.name].ends = now + part.seconds

    def clear(self, layer: str) -> None:
        for key in [key for key in self._shown if key[0] == layer]:
            self._remove(key)

    def place(self, frames: FrameTree, fixed: str, now: float) -> None:
        """Move every shape to its frame and hide those whose frame is not connected.

        Args:
            frames: Tree of frames.
            fixed: Fixed frame.
            now: Steady-clock time [s], as for ``show``.
        """
        for key in [key for key, shown in self._shown.items() if shown.ends <= now]:
            self._remove(key)
        poses: Dict[Tuple[str, Optional[float]], Optional[np.ndarray]] = {}
        for shown in self._shown.values():
            seen_from = shown.part.frame or fixed, shown.part.stamp
            if seen_from not in poses:
                poses[seen_from] = frames.pose(seen_from[0], fixed, seen_from[1])
            pose = poses[seen_from]
            if shown.node.visible != (pose is not None):
                shown.node.visible = pose is not None
            if pose is not None:
                _move(shown, pose if shown.part.pose is None else pose @ shown.part.pose)

    def _put(self, key: Tuple[str, str], part: PlacedShape) -> None:
        shown = self._shown.get(key)
        path = "/layers/" + "/".join(_path_word(word) for word in key)
        if shown is not None and type(shown.part.shape) is type(part.shape):
            shown.part = part
            _update(self._scene, f"{path}/shape", shown)
            return
        if shown is not None:
            self._remove(key)
        node = self._scene.add_frame(path, show_axes=False, visible=False)
        shown = self._shown[key] = _SceneNode(part, node, None)
        _update(self._scene, f"{path}/shape", shown)

    def _remove(self, key: Tuple[str, str]) -> None:
        self._shown.pop(key).node.remove()


def _move(shown: _SceneNode, pose: np.ndarray) -> None:
    if shown.pose is not None and np.abs(pose - shown.pose).max() < STILL:
        return
    if shown.pose is None or np.abs(pose[:3, :3] - shown.pose[:3, :3]).max() >= STILL:
        shown.node.wxyz = wxyz_of(pose)
    if shown.pose is None or np.abs(pose[:3, 3] - shown.pose[:3, 3]).max() >= STILL:
        shown.node.position = pose[:3, 3]
    shown.pose = pose


def _update(scene, path: str, shown: _SceneNode) -> None:
    """Send a shape if it has changed."""
    digest = _digest(shown.part.shape)
    if digest == shown.digest:
        return
    shown.digest = digest
    shown.shape = _DRAWN[type(shown.part.shape)](scene, path, shown.part.shape, shown.shape)


def _digest(shape) -> bytes:
    found = hashlib.blake2b(digest_size=16)
    for value in vars(shape).values():
        found.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
        found.update(b"|")
    return found.digest()


def _points(scene, path: str, shape: PointCloudShape, old):
    if old is not None:
        old.points, old.colors = shape.points.astype(np.float32), np.asarray(shape.colours, np.uint8)
        return old
    return scene.add_point_cloud(
        path,
        shape.points,
        shape.colours,
        point_size=shape.size,
        point_shape="circle",
        point_shading="flat",
        precision="float32",
    )


def _lines(scene, path: str, shape: LineSegments, old):
    if old is not None:
        old.points, old.colors = shape.segments.astype(np.float32), np.asarray(shape.colours, np.uint8)
        return old
    return scene.add_line_segments(
        path, shape.segments, shape.colours, thickness=shape.width, thickness_units="screen"
    )


def _surface(scene, path: str, shape: TriangleMesh, _old):
    return scene.add_mesh_simple(
        path,
        shape.vertices,
        shape.triangles,
        color=shape.colour,
        opacity=None if shape.opacity >= 1.0 else shape.opacity,
        flat_shading=not shape.is_smooth,
        side="double",
    )


def _floor(scene, path: str, shape: FloorImage, _old):
    middle = np.eye(4)
    middle[:3, 3] = shape.width / 2.0, shape.height / 2.0, 0.0
    pose = shape.pose @ middle @ LAID_DOWN
    return scene.add_image(
        path,
        shape.picture,
        shape.width,
        shape.height,
        format="png",
        wxyz=wxyz_of(pose),
        position=pose[:3, 3],
    )


def _label(scene, path: str, shape: Label, _old):
    return scene.add_label(path, shape.text, position=shape.position)


def _axes(scene, path: str, shape: FrameAxes, _old):
    wxyzs = viser.transforms.SO3.from_matrix(shape.poses[:, :3, :3]).wxyz
    return scene.add_batched_axes(
        path, wxyzs, shape.poses[:, :3, 3], axes_length=shape.length, axes_radius=shape.length / 30.0
    )


_DRAWN: Dict[type, Callable] = {
    PointCloudShape: _points,
    LineSegments: _lines,
    TriangleMesh: _surface,
    FloorImage: _floor,
    Label: _label,
    FrameAxes: _axes,
}


def _path_word(text: str) -> str:
    """Escape a word of a scene path, in which a slash separates levels."""
    return text.strip("/").replace("/", ":") or "it"
