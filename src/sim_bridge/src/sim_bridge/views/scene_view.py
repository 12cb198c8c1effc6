"""What sensors see of a scene, computed when it is first needed."""

from dataclasses import replace
from typing import Callable, Dict, List, Tuple, Union

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.views.render_geometry import RenderGeometry
from sim_bridge.views.section import CrossSection
from sim_bridge.world import Body


class SceneView:
    """Cross-sections for range finders and triangles for cameras.

    A viewer is a model, which does not see itself.

    Args:
        pose_of: Returns the present pose (4, 4) of a body.
    """

    def __init__(self, pose_of: Callable[[str], np.ndarray]):
        self._pose_of = pose_of
        self._bodies: Dict[str, Body] = {}
        self._docks: List[str] = []
        self._sections: Dict[Tuple[str, float], CrossSection] = {}
        # At most one; computed when a camera first needs it, since loading meshes may take seconds.
        self._render_geometry: List[RenderGeometry] = []

    @property
    def warnings(self) -> Tuple[str, ...]:
        """One text for each visual that cannot be rendered, known after the first image."""
        return tuple(warning for geometry in self._render_geometry for warning in geometry.warnings)

    def add(self, body: Body) -> None:
        """Add a body."""
        self._bodies[body.name] = body
        if body.is_dock:
            self._docks.append(body.name)
        for geometry in self._render_geometry:
            geometry.add(body)
        for (viewer, _), section in self._sections.items():
            if body.model != viewer:
                section.add(body)

    def remove(self, name: str) -> None:
        """Remove a body."""
        body = self._bodies.pop(name, None)
        if body is not None and body.is_dock:
            self._docks.remove(name)
        for view in self._views():
            view.remove(name)

    def move(self, name: str, pose: np.ndarray) -> None:
        """Move a static body; the poses of others are read from the engine.

        Args:
            name: Name of the body; others than static ones are ignored.
            pose: Pose (4, 4) in the world.
        """
        if name in self._bodies and self._bodies[name].is_static:
            self._bodies[name] = replace(self._bodies[name], pose_in_world=pose)
            for view in self._views():
                view.move(name, pose)

    def update(self) -> None:
        """Recompute the cross-sections of moving bodies, after a state of the engine was restored."""
        for section in self._sections.values():
            section.update(self._pose_of)

    def remove_viewer(self, viewer: str) -> None:
        """Discard the cross-sections that were computed for a viewer."""
        self._sections = {key: section for key, section in self._sections.items() if key[0] != viewer}

    def section(self, viewer: str, height: float) -> Tuple[np.ndarray, np.ndarray]:
        """Return the cross-section that a viewer measures.

        Args:
            viewer: Name of the viewer's model, which is left out.
            height: Height above the world's origin [m].

        Returns:
            Segments (N, 4) as x, y, x, y in the world [m], and the laser_retro (N,) of each.
        """
        section = self._sections.get((viewer, height))
        if section is None:
            section = self._sections[viewer, height] = CrossSection(height)
            for body in self._bodies.values():
                if body.model != viewer:
                    section.add(body)
        return section.segments(self._pose_of), section.retros()

    def laser_retro(self, link: str) -> float:
        """Return the largest laser_retro of a body's collisions; 0 for the name of no body."""
        parts = self._bodies[link].collisions if link in self._bodies else ()
        return max((part.laser_retro for part in parts), default=0.0)

    def docks(self) -> List[Pose2]:
        """Return the poses of all docks in the world."""
        return [to_pose2(self._pose_of(name)) for name in self._docks]

    def triangles(self, viewer: str = "") -> Tuple[np.ndarray, np.ndarray]:
        """Return the surfaces that a camera can see.

        Args:
            viewer: Name of the viewer's model, which is left out; empty for none.

        Returns:
            Triangles (T, 3, 3) in the world [m], and their shaded colours (T, 3), uint8.
        """
        if not self._render_geometry:
            self._render_geometry.append(RenderGeometry())
            for body in self._bodies.values():
                self._render_geometry[0].add(body)
        return self._render_geometry[0].triangles(self._pose_of, excluded_model=viewer)

    def _views(self) -> List[Union[RenderGeometry, CrossSection]]:
        return [*self._render_geometry, *self._sections.values()]
