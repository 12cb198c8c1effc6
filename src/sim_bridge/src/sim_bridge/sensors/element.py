"""The elements of a robot's description that describe a sensor."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.values import number, text


@dataclass(frozen=True, eq=False)
class SensorElement:
    """A sensor of a robot's description.

    Attributes:
        plugin: The <plugin> of the sensor.
        sensor: The <sensor> that contains it; the plugin again if it is directly below the model.
        link: Name of the link that the sensor is fixed to.
        pose_in_base: Pose (4, 4) of the sensor in the base frame.
        namespace: Namespace of the robot.
    """

    plugin: Element
    sensor: Element
    link: str
    pose_in_base: np.ndarray
    namespace: str = ""

    @property
    def update_rate(self) -> Optional[float]:
        """Rate of the <sensor> [Hz]; None if it has none."""
        return number(self.sensor, "update_rate", 0.0) or None

    def topic(self, tag: str, default: str) -> str:
        """Return a topic of the plugin, relative to the robot's namespace if both have the same.

        Args:
            tag: Child of the plugin with the topic's name.
            default: Name if there is no such child.
        """
        topic, namespace = text(self.plugin, tag, default), namespace_of(self.plugin)
        if topic.startswith("/") or namespace in ("", self.namespace):
            return topic
        return f"/{namespace}/{topic}"


def namespace_of(plugin: Element) -> str:
    """Return the namespace of a plugin's topics."""
    return text(plugin, "robotNamespace", "").strip("/")
