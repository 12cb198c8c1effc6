"""The world of a plan as SDF 1.6, which Gazebo Classic, libsdformat and sim_bridge read."""

import math
from typing import Iterator, Sequence
from xml.sax.saxutils import quoteattr

from home_builder.palette import BOX, KINDS, OUTLINE, OUTLINE_COLOUR, Triple
from home_builder.plan.geometry import end_extensions, wall_blocks
from home_builder.plan.model import FurniturePiece, HomePlan

WALL_COLOUR = (0.92, 0.9, 0.86)
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
    parts = [HEAD.format(name=quoteattr(plan.name))]
    parts += _walls_model(plan)
    for number, piece in enumerate(plan.furniture, 1):
        parts += _furniture_model(plan, piece, number)
    return "".join([*parts, TAIL])


def _walls_model(plan: HomePlan) -> Iterator[str]:
    if not plan.walls:
        return
    yield f"    <model name='walls'>\n      <static>true</static>\n      <pose>{_origin(plan)}</pose>\n"
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


def _furniture_model(plan: HomePlan, piece: FurniturePiece, number: int) -> Iterator[str]:
    x, y = piece.x - plan.start[0], piece.y - plan.start[1]
    yield f"    <model name='{piece.kind}_{number}'>\n      <static>true</static>\n"
    yield f"      <pose>{_numbers(x, y, 0.0, 0.0, 0.0, piece.yaw)}</pose>\n      <link name='link'>\n"
    if piece.kind == OUTLINE:
        yield from _solid("outline", (0.0, 0.0, 0.0), _polyline(piece), OUTLINE_COLOUR)
    else:
        for index, part in enumerate(KINDS[piece.kind].parts):
            size = part.extent(piece.size)
            shape = _box(size) if part.shape == BOX else _cylinder(size)
            yield from _solid(f"part_{index}", part.middle(piece.size), shape, part.colour)
    yield "      </link>\n    </model>\n"


def _solid(name: str, where: Triple, shape: str, colour: Triple) -> Iterator[str]:
    pose = f"<pose>{_numbers(*where, 0.0, 0.0, 0.0)}</pose>"
    geometry = f"<geometry>{shape}</geometry>"
    shade = f"{_numbers(*colour)} 1"
    material = f"<material><ambient>{shade}</ambient><diffuse>{shade}</diffuse></material>"
    yield f"        <collision name='{name}'>{pose}{geometry}</collision>\n"
    yield f"        <visual name='{name}'>{pose}{geometry}{material}</visual>\n"


def _box(size: Sequence[float]) -> str:
    return f"<box><size>{_numbers(*size)}</size></box>"


def _cylinder(size: Triple) -> str:
    radius = math.sqrt(size[0] * size[1]) / 2.0
    return f"<cylinder><radius>{radius:.6g}</radius><length>{size[2]:.6g}</length></cylinder>"


def _polyline(piece: FurniturePiece) -> str:
    points = "".join(f"<point>{_numbers(*corner)}</point>" for corner in piece.corners)
    return f"<polyline>{points}<height>{piece.size[2]:.6g}</height></polyline>"


def _origin(plan: HomePlan) -> str:
    return _numbers(-plan.start[0], -plan.start[1], 0.0, 0.0, 0.0, 0.0)


def _numbers(*values: float) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in values)
