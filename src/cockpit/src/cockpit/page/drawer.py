"""Puts what layers draw into the scene, and keeps it where its frames are."""

import hashlib
from dataclasses import dataclass
from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np
import viser.transforms

from cockpit.drawing import Axes, Drawing, Floor, Label, Lines, Part, Points, Surface
from cockpit.frames import FrameTree, wxyz_of

STILL = 1e-6
EVERYTHING = "*"
# viser's pictures lie in the plane of a camera: x to the right, y down.
LAID_DOWN = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass
class _Shown:
    """A part in the scene: ``node`` has its place, ``thing`` hangs from it; ``pose``: as it was last sent."""

    part: Part
    node: Any
    thing: Any
    pose: Optional[np.ndarray] = None
    digest: bytes = b""
    ends: float = np.inf


class Drawer:
    """Holds what each layer shows."""

    def __init__(self, scene):
        self._scene = scene
        self._shown: Dict[Tuple[str, str], _Shown] = {}

    def show(self, layer: str, drawing: Drawing, now: float = 0.0) -> None:
        """Shows what ``layer`` has drawn, in place of what it showed before."""
        names = {part.name for part in drawing.parts}
        for key in list(self._shown):
            if (
                key[0] == layer
                and key[1] not in names
                and (not drawing.keeps or EVERYTHING in drawing.gone or key[1] in drawing.gone)
            ):
                self._remove(key)
        for part in drawing.parts:
            self._put((layer, part.name), part)
            self._shown[layer, part.name].ends = now + part.seconds

    def clear(self, layer: str) -> None:
        for key in [key for key in self._shown if key[0] == layer]:
            self._remove(key)

    def place(self, frames: FrameTree, fixed: str, now: float) -> None:
        """Moves every part to where its frame is now; hides those whose frame leads nowhere.

        ``now``: seconds by a steady clock, as for ``show``.
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

    def _put(self, key: Tuple[str, str], part: Part) -> None:
        shown = self._shown.get(key)
        path = "/layers/" + "/".join(_path_word(word) for word in key)
        if shown is not None and type(shown.part.thing) is type(part.thing):
            shown.part = part
            _update(self._scene, f"{path}/thing", shown)
            return
        if shown is not None:
            self._remove(key)
        node = self._scene.add_frame(path, show_axes=False, visible=False)
        shown = self._shown[key] = _Shown(part, node, None)
        _update(self._scene, f"{path}/thing", shown)

    def _remove(self, key: Tuple[str, str]) -> None:
        self._shown.pop(key).node.remove()


def _move(shown: _Shown, pose: np.ndarray) -> None:
    if shown.pose is not None and np.abs(pose - shown.pose).max() < STILL:
        return
    if shown.pose is None or np.abs(pose[:3, :3] - shown.pose[:3, :3]).max() >= STILL:
        shown.node.wxyz = wxyz_of(pose)
    if shown.pose is None or np.abs(pose[:3, 3] - shown.pose[:3, 3]).max() >= STILL:
        shown.node.position = pose[:3, 3]
    shown.pose = pose


def _update(scene, path: str, shown: _Shown) -> None:
    """Sends a part's thing if it is another than the one that is shown."""
    digest = _digest(shown.part.thing)
    if digest == shown.digest:
        return
    shown.digest = digest
    shown.thing = _DRAWN[type(shown.part.thing)](scene, path, shown.part.thing, shown.thing)


def _digest(thing) -> bytes:
    found = hashlib.blake2b(digest_size=16)
    for value in vars(thing).values():
        found.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
        found.update(b"|")
    return found.digest()


def _points(scene, path: str, thing: Points, old):
    if old is not None:
        old.points, old.colors = thing.points.astype(np.float16), np.asarray(thing.colours, np.uint8)
        return old
    return scene.add_point_cloud(
        path, thing.points, thing.colours, point_size=thing.size, point_shape="circle", point_shading="flat"
    )


def _lines(scene, path: str, thing: Lines, old):
    if old is not None:
        old.points, old.colors = thing.segments.astype(np.float32), np.asarray(thing.colours, np.uint8)
        return old
    return scene.add_line_segments(
        path, thing.segments, thing.colours, thickness=thing.width, thickness_units="screen"
    )


def _surface(scene, path: str, thing: Surface, _old):
    return scene.add_mesh_simple(
        path,
        thing.vertices,
        thing.triangles,
        color=thing.colour,
        opacity=None if thing.opacity >= 1.0 else thing.opacity,
        flat_shading=not thing.is_smooth,
        side="double",
    )


def _floor(scene, path: str, thing: Floor, _old):
    middle = np.eye(4)
    middle[:3, 3] = thing.width / 2.0, thing.height / 2.0, 0.0
    pose = thing.pose @ middle @ LAID_DOWN
    return scene.add_image(
        path,
        thing.picture,
        thing.width,
        thing.height,
        format="png",
        wxyz=wxyz_of(pose),
        position=pose[:3, 3],
    )


def _label(scene, path: str, thing: Label, _old):
    return scene.add_label(path, thing.text, position=thing.position)


def _axes(scene, path: str, thing: Axes, _old):
    wxyzs = viser.transforms.SO3.from_matrix(thing.poses[:, :3, :3]).wxyz
    return scene.add_batched_axes(
        path, wxyzs, thing.poses[:, :3, 3], axes_length=thing.length, axes_radius=thing.length / 30.0
    )


_DRAWN: Dict[type, Callable] = {
    Points: _points,
    Lines: _lines,
    Surface: _surface,
    Floor: _floor,
    Label: _label,
    Axes: _axes,
}


def _path_word(text: str) -> str:
    """A word of a path in the scene, in which a slash would mean a level."""
    return text.strip("/").replace("/", ":") or "it"
