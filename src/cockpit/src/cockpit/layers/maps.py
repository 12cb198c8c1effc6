"""Occupancy grids: maps, and costmaps in rviz's colours."""

import numpy as np

from cockpit.drawing import FloorImage, LayerUpdate, PlacedShape
from cockpit.errors import CockpitError
from cockpit.frames import pose_matrix
from cockpit.layer import DisplayLayer

UNKNOWN, LETHAL, INSCRIBED = -1, 100, 99
LARGEST = 4000 * 4000


def _map_colours() -> np.ndarray:
    """The colour (256, 4) uint8 of each value of a map: unknown, free to occupied."""
    table = np.zeros((256, 4), np.uint8)
    shade = np.linspace(245, 30, 101).astype(np.uint8)
    table[:101] = np.column_stack((shade, shade, shade, np.full(101, 235)))
    table[:101, 2] = np.minimum(table[:101, 2].astype(int) + 6, 255)
    table[256 + UNKNOWN] = (150, 158, 160, 90)
    return table


def _costmap_colours() -> np.ndarray:
    """The costmap colours of rviz: blue to red, cyan for inscribed cells, magenta for lethal ones."""
    table = np.zeros((256, 4), np.uint8)
    share = np.arange(1, 99) / 98.0
    table[1:99] = np.column_stack((255 * share, np.zeros(98), 255 * (1 - share), 60 + 90 * share))
    table[INSCRIBED] = (0, 220, 220, 170)
    table[LETHAL] = (220, 0, 220, 190)
    return table


MAP_COLOURS, COSTMAP_COLOURS = _map_colours(), _costmap_colours()


def picture_of(cells: np.ndarray, is_costmap: bool) -> np.ndarray:
    """Convert the cells of a grid to an image.

    Args:
        cells: Occupancy (rows, columns), int8, row 0 lowest.
        is_costmap: Whether the colours are those of costmaps.

    Returns:
        Image (rows, columns, 4), uint8, row 0 at the top.
    """
    colours = COSTMAP_COLOURS if is_costmap else MAP_COLOURS
    return colours[cells[::-1].view(np.uint8)]


def draw_as(is_costmap: bool, height: float):
    """Return a function that draws grids.

    Args:
        is_costmap: Whether the colours are those of costmaps.
        height: Height of the image [m]; different heights of several grids avoid flicker.
    """

    def draw(message) -> LayerUpdate:
        info = message.info
        if not 0 < info.width * info.height <= LARGEST or len(message.data) != info.width * info.height:
            raise CockpitError(f"a grid of {info.width} x {info.height} with {len(message.data)} cells")
        cells = np.asarray(message.data, dtype=np.int8).reshape(info.height, info.width)
        origin = info.origin
        corner = pose_matrix(
            (origin.position.x, origin.position.y, origin.position.z + height),
            (origin.orientation.x, origin.orientation.y, origin.orientation.z, origin.orientation.w),
        )
        if corner is None or not 0.0 < info.resolution < 1e3:
            raise CockpitError("the grid's origin is not finite, or its resolution is not positive")
        size = info.width * info.resolution, info.height * info.resolution
        picture = picture_of(cells, is_costmap)
        return LayerUpdate(
            (PlacedShape("grid", message.header.frame_id, FloorImage(picture, *size, corner)),)
        )

    return draw


class GridLayer:
    """Draws the grids of a topic; values between free and lethal identify a costmap."""

    def __call__(self, message) -> LayerUpdate:
        values = np.asarray(message.data, dtype=np.int8)
        is_costmap = bool(((values > 0) & (values < LETHAL)).any())
        return draw_as(is_costmap, 0.02 if is_costmap else 0.01)(message)


LAYER = DisplayLayer("Map and costmaps", ("nav_msgs/OccupancyGrid",), GridLayer, shown=("/map",), seconds=0.5)
