"""The world of a plan as SDF 1.6, which Gazebo Classic, libsdformat and sim_bridge read."""

import math
from typing import Iterator, List, Sequence, Tuple
from xml.sax.saxutils import quoteattr

import numpy as np
import shapely
from shapely.geometry import Polygon

from home_builder.palette import BOX, KINDS, OUTLINE, OUTLINE_COLOUR, Triple
from home_builder.plan.frames import plan_in_world
from home_builder.plan.geometry import end_extensions, wall_blocks
from home_builder.plan.model import FurniturePiece, HomePlan

WALL_COLOUR = (0.92, 0.9, 0.86)
# Size of the cells from which the inside of an outline is made [m].
CORE_CELL = 0.1
HEAD = """<?xml version='1.0'?>
<!-- Made by build_home.sh from plan.yaml; the robot starts at the origin. -->
<sdf version='1.6'>
  <world name={name}>
    <include><uri>model://sun</uri></include>
    <include><uri>model://ground_plane</uri></include>
    <gravity>0 0 -9.8</gravity>
    <physics name='default_physics' default='0' type='ode'>
      <max_step_size>0.005</max_step_size>
      <real_time_factor>1</real_time_factor>
      <real_time_update_rate>200</real_time_update_rate>
    </physics>
"""
TAIL = "  </world>\n</sdf>\n"


def world_text(plan: HomePlan) -> str:
    """Return the SDF of a plan, with the start of the robot at the origin."""
    plan = plan_in_world(plan)
    parts = [HEAD.format(name=quoteattr(plan.name))]
    parts += _walls_model(plan)
    for number, piece in enumerate(plan.furniture, 1):
        parts += _furniture_model(piece, number)
    return "".join([*parts, TAIL])


def _walls_model(plan: HomePlan) -> Iterator[str]:
    if not plan.walls:
        return
    yield "    <model name='walls'>\n      <static>true</static>\n"
    for number, (wall, extension) in enumerate(zip(plan.walls, end_extensions(plan.walls)), 1):
        middle = wall.point_at(wall.length / 2.0)
        yield f"      <link name='wall_{number}'>\n"
        yield f"        <pose>{_numbers(*middle, 0.0, 0.0, 0.0, wall.yaw)}</pose>\n"
        for index, block in enumerate(wall_blocks(wall, *extension)):
            first, last, bottom, top = block
            where = ((first + last - wall.length) / 2.0, 0.0, (bottom + top) / 2.0)
            size = (last - first, wall.thickness, top - bottom)
            yield from _solid(f"part_{index}", where, _box(size), WALL_COLOUR)
        yield "      </link>\n"
    yield "    </model>\n"


def _furniture_model(piece: FurniturePiece, number: int) -> Iterator[str]:
    yield f"    <model name='{piece.kind}_{number}'>\n      <static>true</static>\n"
    pose = _numbers(piece.x, piece.y, 0.0, 0.0, 0.0, piece.yaw)
    yield f"      <pose>{pose}</pose>\n      <link name='link'>\n"
    if piece.kind == OUTLINE:
        yield from _solid("outline", (0.0, 0.0, 0.0), _polyline(piece), OUTLINE_COLOUR)
        for index, (x1, y1, x2, y2) in enumerate(core_boxes(piece)):
            where = ((x1 + x2) / 2.0, (y1 + y2) / 2.0, piece.size[2] / 2.0)
            yield _collision(f"core_{index}", where, _box((x2 - x1, y2 - y1, piece.size[2])))
    else:
        for index, part in enumerate(KINDS[piece.kind].parts):
            size = part.extent(piece.size)
            shape = _box(size) if part.shape == BOX else _cylinder(size)
            yield from _solid(f"part_{index}", part.middle(piece.size), shape, part.colour)
    yield "      </link>\n    </model>\n"


def _solid(name: str, where: Triple, shape: str, colour: Triple) -> Iterator[str]:
    pose = f"<pose>{_numbers(*where, 0.0, 0.0, 0.0)}</pose>"
    geometry = f"<geometry>{shape}</geometry>"
    yield _collision(name, where, shape)
    shade = f"{_numbers(*colour)} 1"
    material = f"<material><ambient>{shade}</ambient><diffuse>{shade}</diffuse></material>"
    yield f"        <visual name='{name}'>{pose}{geometry}{material}</visual>\n"


def _collision(name: str, where: Triple, shape: str) -> str:
    pose = f"<pose>{_numbers(*where, 0.0, 0.0, 0.0)}</pose>"
    return f"        <collision name='{name}'>{pose}<geometry>{shape}</geometry></collision>\n"


def core_boxes(piece: FurniturePiece) -> List[Tuple[float, float, float, float]]:
    """Return boxes that fill an outline, which simulators treat as a shell.

    Args:
        piece: Furniture of the kind ``outline``.

    Returns:
        Smallest x and y, largest x and y of each, in the frame of the piece [m].
    """
    inside = Polygon(piece.corners).buffer(-CORE_CELL / 2.0)
    if inside.is_empty:
        return []
    low_x, low_y, high_x, high_y = inside.bounds
    cols, rows = (max(1, int(side / CORE_CELL)) for side in (high_x - low_x, high_y - low_y))
    x = np.linspace(low_x, high_x, cols + 1)
    y = np.linspace(low_y, high_y, rows + 1)
    middle_x, middle_y = np.meshgrid((x[1:] + x[:-1]) / 2.0, (y[1:] + y[:-1]) / 2.0)
    filled = shapely.contains_xy(inside, middle_x, middle_y)
    changes = [0, *(np.flatnonzero((filled[1:] != filled[:-1]).any(axis=1)) + 1).tolist(), rows]
    boxes = []
    for first, last in zip(changes, changes[1:]):  # bands of equal rows
        edges = np.flatnonzero(np.diff(np.concatenate(([0], filled[first].astype(np.int8), [0]))))
        for begin, end in zip(edges[::2], edges[1::2]):
            boxes.append((float(x[begin]), float(y[first]), float(x[end]), float(y[last])))
    return boxes


def _box(size: Sequence[float]) -> str:
    return f"<box><size>{_numbers(*size)}</size></box>"


def _cylinder(size: Triple) -> str:
    radius = math.sqrt(size[0] * size[1]) / 2.0
    return f"<cylinder><radius>{radius:.6g}</radius><length>{size[2]:.6g}</length></cylinder>"


def _polyline(piece: FurniturePiece) -> str:
    points = "".join(f"<point>{_numbers(*corner)}</point>" for corner in piece.corners)
    return f"<polyline>{points}<height>{piece.size[2]:.6g}</height></polyline>"


def _numbers(*values: float) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in values)
