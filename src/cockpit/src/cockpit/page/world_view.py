"""The world and the robots in the 3D scene."""

from itertools import groupby
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from cockpit.frames import FrameTree, wxyz_of
from cockpit.scene.description import DisplayJoint, SceneDescription, VisualPart, cut_at, merged

STILL = 1e-5


class LinkView:
    """The visual parts of a link: a scene node with a mesh for each colour.

    Args:
        scene: The scene of viser.
        path: Name of the scene node.
        parts: Visual parts of the link.
    """

    def __init__(self, scene, path: str, parts: Tuple[VisualPart, ...]):
        self._scene, self._path = scene, path
        self.parts = parts
        self.node = scene.add_frame(path, show_axes=False)
        self._surfaces: List[Any] = []
        self._pose: Optional[np.ndarray] = None

    def draw(self, height: float) -> None:
        """Draw the parts.

        Args:
            height: Height in the world above which they are cut off [m].
        """
        for surface in self._surfaces:
            surface.remove()
        cut = tuple(cut_at(part, height) for part in self.parts)
        self._surfaces = [
            self._scene.add_mesh_simple(
                f"{self._path}/{number}",
                vertices,
                triangles,
                color=colour,
                flat_shading=True,
                side="double",
            )
            for number, (vertices, triangles, colour) in enumerate(merged(cut))
        ]

    def move(self, pose: Optional[np.ndarray]) -> None:
        """Move the link.

        Args:
            pose: Pose (4, 4) in the fixed frame; None hides the link.
        """
        if self.node.visible != (pose is not None):
            self.node.visible = pose is not None
        if pose is None or (self._pose is not None and np.abs(pose - self._pose).max() < STILL):
            return
        if self._pose is None or np.abs(pose[:3, :3] - self._pose[:3, :3]).max() >= STILL:
            self.node.wxyz = wxyz_of(pose)
        self.node.position = pose[:3, 3]
        self._pose = pose

    def remove(self) -> None:
        self.node.remove()


class WorldView:
    """The models of a world. A link keeps its pose until ``place`` or ``move`` changes it."""

    def __init__(self, scene):
        self._scene = scene
        self._links: Dict[str, LinkView] = {}
        self._poses: Dict[str, np.ndarray] = {}
        self._height = np.inf
        self.joints: Dict[str, DisplayJoint] = {}
        self.is_shown = True

    @property
    def movable(self) -> List[str]:
        """Names ``model::link`` of links that the physics moves."""
        return [name for name, link in self._links.items() if link.parts[0].moves]

    @property
    def models(self) -> List[str]:
        return sorted({link.parts[0].model for link in self._links.values()})

    def show(self, description: SceneDescription) -> None:
        def link_of(part: VisualPart) -> str:
            return f"{part.model}::{part.link}"

        self.joints.update({f"{joint.model}: {joint.name}": joint for joint in description.joints})
        for name, parts in groupby(sorted(description.parts, key=link_of), link_of):
            link = LinkView(self._scene, f"/world/{name.replace('/', ':')}", tuple(parts))
            link.draw(self._height)
            self._links[name] = link
            self._poses[name] = link.parts[0].pose

    def remove(self, model: str) -> None:
        """Remove a model, if it exists."""
        for name in [name for name, link in self._links.items() if link.parts[0].model == model]:
            self._links.pop(name).remove()
            del self._poses[name]
        self.joints = {name: joint for name, joint in self.joints.items() if joint.model != model}

    def cut(self, height: float) -> None:
        """Hide roofs and the upper part of walls.

        Args:
            height: Height above which everything is hidden [m].
        """
        self._height = height
        for link in self._links.values():
            link.draw(height)

    def place(self, name: str, pose_in_world: np.ndarray) -> None:
        """Set the pose of a link; a link that is not displayed is ignored.

        Args:
            name: Name of the link, ``model::link``.
            pose_in_world: Pose (4, 4).
        """
        if name in self._poses:
            self._poses[name] = pose_in_world

    def move(self, model: str, motion: np.ndarray) -> None:
        """Move a model.

        Args:
            model: Name of the model.
            motion: Motion (4, 4) in the world frame.
        """
        for name, link in self._links.items():
            if link.parts[0].model == model:
                self._poses[name] = motion @ self._poses[name]

    def update(self, world_in_fixed: Optional[np.ndarray]) -> None:
        """Move all links to their present poses.

        Args:
            world_in_fixed: Pose (4, 4) of the world in the fixed frame; None hides the world.
        """
        for name, link in self._links.items():
            shown = world_in_fixed is not None and self.is_shown
            link.move(world_in_fixed @ self._poses[name] if shown else None)


class RobotView:
    """The links of a robot, placed by tf.

    Args:
        scene: The scene of viser.
        name: Name of the robot's scene node.
        description: Visual parts of its links.
        prefix: Its tf_prefix.
    """

    def __init__(self, scene, name: str, description: SceneDescription, prefix: str):
        self._prefix = f"{prefix.strip('/')}/" if prefix.strip("/") else ""
        self._links: Dict[str, LinkView] = {}
        for link, parts in groupby(sorted(description.parts, key=_link), _link):
            path = f"/robots/{name.strip('/').replace('/', ':') or 'robot'}/{link}"
            self._links[link] = LinkView(scene, path, tuple(parts))
            self._links[link].draw(np.inf)

    def update(self, frames: FrameTree, fixed: str, is_shown: bool) -> None:
        """Move all links to their present poses.

        Args:
            frames: Tree of frames.
            fixed: Fixed frame.
            is_shown: Whether the robot is displayed.
        """
        for name, view in self._links.items():
            view.move(frames.pose(self._prefix + name, fixed) if is_shown else None)

    def remove(self) -> None:
        for link in self._links.values():
            link.remove()


def _link(part: VisualPart) -> str:
    return part.link
