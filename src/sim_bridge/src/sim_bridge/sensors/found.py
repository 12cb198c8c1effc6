"""A sensor as it was found in a robot's description."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.values import number, text


@dataclass(frozen=True, eq=False)
class Found:
    """A ``plugin`` and the ``sensor`` that it is in, or the plugin again if it is directly below the model.

    ``link``: that the sensor is fixed to, at ``pose_in_base``, (4, 4); ``namespace``: the robot's.
    """

    plugin: Element
    sensor: Element
    link: str
    pose_in_base: np.ndarray
    namespace: str = ""

    @property
    def update_rate(self) -> Optional[float]:
        """Of the <sensor>, hertz; None if it says nothing."""
        return number(self.sensor, "update_rate", 0.0) or None

    def topic(self, tag: str, default: str) -> str:
        """A topic; absolute if the plugin has another namespace than its robot."""
        topic, namespace = text(self.plugin, tag, default), namespace_of(self.plugin)
        if topic.startswith("/") or namespace in ("", self.namespace):
            return topic
        return f"/{namespace}/{topic}"


def namespace_of(plugin: Element) -> str:
    """What a plugin puts before its topics."""
    return text(plugin, "robotNamespace", "").strip("/")
