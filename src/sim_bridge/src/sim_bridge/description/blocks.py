"""What a model says for Gazebo's plugins."""

from dataclasses import dataclass, field
from typing import List, Tuple

from sim_bridge.sdf.element import Element


@dataclass
class Blocks:
    """<plugin> elements of a model, and <sensor> elements, each with the link that it is fixed to."""

    plugins: List[Element] = field(default_factory=list)
    sensors: List[Tuple[str, Element]] = field(default_factory=list)

    def add(self, parent: Element, link: str) -> None:
        """Takes what is directly below an element: <gazebo> of URDF, <model> or <link> of SDF."""
        self.plugins.extend(parent.children("plugin"))
        self.sensors.extend((link, sensor) for sensor in parent.children("sensor"))
