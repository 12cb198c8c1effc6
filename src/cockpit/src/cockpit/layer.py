"""The contract of a layer: how the messages of a topic are drawn."""

from dataclasses import dataclass
from typing import Any, Callable, Tuple

from cockpit.drawing import LayerUpdate
from planar.deprecation import deprecated_names

# Converts a message to a LayerUpdate. One object per topic, so it may keep state, as markers do.
# Raises CockpitError if the message cannot be drawn; any other exception is reported as well.
Draw = Callable[[Any], LayerUpdate]


@dataclass(frozen=True)
class DisplayLayer:
    """How messages of some types are shown.

    A layer is a module of ``cockpit/layers`` that defines one as ``LAYER``; it is found automatically. It
    never imports ROS: it reads the fields of the messages.

    Life cycle: only the newest message of an enabled topic is drawn, at most ten times a second of wall time.
    While the topic is disabled or no page is open, it is not subscribed to.

    Attributes:
        title: Heading of its topics.
        types: Message types, such as "sensor_msgs/LaserScan".
        make: Creates the ``Draw`` function for one topic.
        shown: Ends of the names of topics that are enabled at first.
        seconds: Shortest time between two updates [wall s].
        needs_all: Whether every message is drawn in order, since each adds to those before.
    """

    title: str
    types: Tuple[str, ...]
    make: Callable[[], Draw]
    shown: Tuple[str, ...] = ()
    seconds: float = 0.1
    needs_all: bool = False

    def is_shown_at_first(self, topic: str) -> bool:
        """Return whether a topic is enabled at first."""
        return topic.endswith(self.shown) if self.shown else False


__getattr__ = deprecated_names(__name__, {"Layer": "DisplayLayer"})
