"""Maps of the static layers from their topics."""

from functools import partial
from typing import Dict, Iterable, List, Optional

import numpy as np
import rospy
from map_msgs.msg import OccupancyGridUpdate

from move_base_lite.costmap import StaticMap, StaticMapSource
from planar import OccupancyGrid
from planar_ros.lockstep import has_synchronized_publisher
from planar_ros.messages.conversion import OccupancyGridArrays, frame_name, grid_from_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import MessageError, subscribe

UPDATE_QUEUE_SIZE = 10
WARN_SECONDS = 5.0


class StaticMapTopics:
    """Subscribes to the maps of static layers; callbacks store them, a tick takes them.

    A map in a frame other than those of the costmaps is transformed to the map frame once, when it is taken.

    Args:
        sources: Where the layers have their maps from.
        frames: Frames of the costmaps, that of the map first.
        transforms: Transforms from tf.
    """

    def __init__(self, sources: Iterable[StaticMapSource], frames: List[str], transforms: Transforms):
        self._frames, self._transforms = frames, transforms
        self._new: Dict[StaticMapSource, StaticMap] = {}
        self._latest: Dict[StaticMapSource, StaticMap] = {}
        self._subscribers = {
            source: subscribe(source.topic, OccupancyGridArrays, partial(self._on_map, source), queue_size=1)
            for source in sorted(sources)
        }
        for source in self._subscribers:
            if source.with_updates:
                handle, topic = partial(self._on_update, source), f"{source.topic}_updates"
                subscribe(topic, OccupancyGridUpdate, handle, queue_size=UPDATE_QUEUE_SIZE)

    def has_map(self, source: StaticMapSource) -> bool:
        """Whether a source has sent a map."""
        return source in self._latest

    def are_in_step(self) -> bool:
        """Whether each source has sent a map, or none is expected from a synchronised node."""
        return all(
            source in self._latest or has_synchronized_publisher(subscriber)
            for source, subscriber in self._subscribers.items()
        )

    def take_new(self) -> Dict[StaticMapSource, StaticMap]:
        """Return the maps since the last call whose frames are known, by source."""
        taken = {}
        for source in [*self._new]:
            static_map = self._in_known_frame(source, self._new[source])
            if static_map is not None:
                taken[source] = static_map
                del self._new[source]
        return taken

    def _in_known_frame(self, source: StaticMapSource, static_map: StaticMap) -> Optional[StaticMap]:
        frame, grid = static_map.frame, static_map.grid
        if frame in ("", *self._frames):
            return static_map
        frame_in_map = self._transforms.lookup(self._frames[0], frame)
        if frame_in_map is None:
            topic = rospy.resolve_name(source.topic)
            text = f"{topic}: no transform from its frame '{frame}' to {self._frames[0]}"
            rospy.logwarn_throttle(WARN_SECONDS, text)
            return None
        moved = OccupancyGrid(grid.cells, grid.resolution, frame_in_map @ grid.origin)
        return StaticMap(moved, self._frames[0])

    def _on_map(self, source: StaticMapSource, message) -> None:
        if source.first_map_only and source in self._latest:
            return
        static_map = StaticMap(grid_from_msg(message), frame_name(message.header.frame_id))
        self._latest[source] = self._new[source] = static_map

    def _on_update(self, source: StaticMapSource, message: OccupancyGridUpdate) -> None:
        latest = self._latest.get(source)
        if latest is None:
            return
        self._latest[source] = self._new[source] = StaticMap(updated(latest.grid, message), latest.frame)


def updated(grid: OccupancyGrid, message: OccupancyGridUpdate) -> OccupancyGrid:
    """Return a map with the block of cells that an update replaces.

    Raises:
        MessageError: The block is not within the map, or its data have another length.
    """
    end_row, end_col = message.y + message.height, message.x + message.width
    is_inside = message.y >= 0 and end_row <= grid.rows and message.x >= 0 and end_col <= grid.cols
    if not is_inside or len(message.data) != message.width * message.height:
        raise MessageError(
            f"an update must lie within the map of {grid.cols} x {grid.rows} cells, got "
            f"{message.width} x {message.height} cells at ({message.x}, {message.y}) with "
            f"{len(message.data)} values"
        )
    cells = grid.cells.copy()
    block = np.asarray(message.data, dtype=np.int8).reshape(message.height, message.width)
    cells[message.y : end_row, message.x : end_col] = block
    return OccupancyGrid(cells, grid.resolution, grid.origin)
