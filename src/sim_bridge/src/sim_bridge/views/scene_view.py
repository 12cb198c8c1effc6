"""What can be seen of the bodies of a scene, made when it is first looked at."""

from dataclasses import replace
from typing import Callable, Dict, List, Tuple, Union

import numpy as np

from sim_bridge.views.render_geometry import RenderGeometry
from sim_bridge.views.section import CrossSection
from sim_bridge.world import Body


class SceneView:
    """Level sections for range finders and a drawing for cameras; ``pose_of`` says where a body is, (4, 4).

    A viewer is a model; it does not see itself.
    """

    def __init__(self, pose_of: Callable[[str], np.ndarray]):
        self._pose_of = pose_of
        self._bodies: Dict[str, Body] = {}
        self._sections: Dict[Tuple[str, float], CrossSection] = {}
        # Meshes may take seconds.
        self._drawings: List[RenderGeometry] = []

    @property
    def warnings(self) -> Tuple[str, ...]:
        """In words, what cameras cannot see, known when they have first looked."""
        return tuple(warning for drawing in self._drawings for warning in drawing.warnings)

    def add(self, body: Body) -> None:
        self._bodies[body.name] = body
        for drawing in self._drawings:
            drawing.add(body)
        for (viewer, _), section in self._sections.items():
            if body.model != viewer:
                section.add(body)

    def remove(self, name: str) -> None:
        self._bodies.pop(name, None)
        for view in self._views():
            view.remove(name)

    def move(self, name: str, pose: np.ndarray) -> None:
        """A body has been put to another place, (4, 4)."""
        if name in self._bodies and self._bodies[name].is_static:
            self._bodies[name] = replace(self._bodies[name], pose_in_world=pose)
            for view in self._views():
                view.move(name, pose)

    def update(self) -> None:
        """Everything may be elsewhere; no trace is left of where it was."""
        for section in self._sections.values():
            section.update(self._pose_of)

    def remove_viewer(self, viewer: str) -> None:
        """A viewer is gone."""
        self._sections = {key: section for key, section in self._sections.items() if key[0] != viewer}

    def section(self, viewer: str, height: float) -> Tuple[np.ndarray, np.ndarray]:
        """Sides (N, 4) of what there is at a height, as x, y, x, y, and how brightly each reflects, (N,)."""
        section = self._sections.get((viewer, height))
        if section is None:
            section = self._sections[viewer, height] = CrossSection(height)
            for body in self._bodies.values():
                if body.model != viewer:
                    section.add(body)
        return section.segments(self._pose_of), section.retros()

    def triangles(self, viewer: str = "") -> Tuple[np.ndarray, np.ndarray]:
        """What cameras see: triangles (T, 3, 3) and their shades (T, 3), uint8."""
        if not self._drawings:
            self._drawings.append(RenderGeometry())
            for body in self._bodies.values():
                self._drawings[0].add(body)
        return self._drawings[0].triangles(self._pose_of, but=viewer)

    def _views(self) -> List[Union[RenderGeometry, CrossSection]]:
        return [*self._drawings, *self._sections.values()]
