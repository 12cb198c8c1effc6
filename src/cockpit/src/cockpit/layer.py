"""The contract of a layer: what is drawn of the messages of a topic."""

from dataclasses import dataclass
from typing import Any, Callable, Tuple

from cockpit.drawing import Drawing

# What makes a drawing of a message. An object of its own for each topic, so it may remember: markers do.
# Raises CockpitError if the message cannot be drawn; whatever else it raises is told as well.
Draw = Callable[[Any], Drawing]


@dataclass(frozen=True)
class Layer:
    """How messages of some types are shown.

    A layer is a module of ``cockpit/layers`` that holds one as ``LAYER``; nothing else has to know of it. It
    never imports ROS: messages are taken as they come, by their fields.

    ``title``: what its topics are listed under. ``types``: of its messages, "sensor_msgs/LaserScan".
    ``make``: makes the ``Draw`` for one topic. ``shown``: the topics that are shown at first, by the end of
    their names. ``seconds``: drawn again no sooner than after so many.

    Life cycle: of a topic that is switched on the newest message alone is drawn, at most ten times a second
    by a wall clock. While no page is open, or it is switched off, the topic is not subscribed to.
    ``needs_all``: every message is drawn in its turn, since each may add to what those before have shown.
    """

    title: str
    types: Tuple[str, ...]
    make: Callable[[], Draw]
    shown: Tuple[str, ...] = ()
    seconds: float = 0.1
    needs_all: bool = False

    def is_shown_at_first(self, topic: str) -> bool:
        return topic.endswith(self.shown) if self.shown else False
