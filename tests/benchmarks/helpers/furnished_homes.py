"""Generated homes with kinds of rooms and furniture, for the search of objects."""

import math
from typing import Dict, NamedTuple, Tuple

import numpy as np

from home_builder.palette import KINDS
from home_builder.semantics import SURFACES, default_priors
from laboratory.generators.floor_plan import THICKNESS, Rectangle, generate_floor_plan
from laboratory.generators.furniture import Furniture
from laboratory.worlds.solids import FLOOR, wall
from planar import OccupancyGrid, Pose2
from planar.maps.semantic_map import FurnitureTop, SemanticMap
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

ROOM_KINDS = ("living room", "kitchen", "bedroom", "bathroom", "hall", "dining room", "office", "bedroom")
# Furniture that is tried in each kind of room.
FURNITURE = {
    "living room": ("sofa", "table", "shelf", "chair", "shelf", "plant"),
    "kitchen": ("kitchen", "table", "chair", "shelf"),
    "bedroom": ("bed", "wardrobe", "table", "shelf", "chair"),
    "bathroom": ("shelf", "box"),
    "hall": ("shelf", "wardrobe", "box"),
    "dining room": ("table", "chair", "chair", "shelf"),
    "office": ("table", "chair", "shelf", "shelf"),
}
# Attempts to place a piece, and share of pieces at a wall.
ATTEMPTS, AT_WALL = 6, 0.8


class FurnishedHome(NamedTuple):
    """A generated home; the robot starts at the origin.

    Attributes:
        grid: Map.
        semantic_map: Rooms, furniture, default priors.
        solids: Rectangles (N, 4) of walls and of furniture higher than a person's chest, x1 y1 x2 y2 [m].
    """

    grid: OccupancyGrid
    semantic_map: SemanticMap
    solids: np.ndarray


def furnished_home(seed: int) -> FurnishedHome:
    """Generate a home of 40 to 250 m2."""
    rng = np.random.default_rng([seed, 77])
    area = math.exp(rng.uniform(math.log(40.0), math.log(250.0)))
    width = math.sqrt(area * rng.uniform(0.7, 1.4))
    outline = Rectangle(0.0, 0.0, width, area / width)
    floor = generate_floor_plan(outline, rng)
    start = floor.rooms[int(rng.integers(len(floor.rooms)))].middle
    kinds = [ROOM_KINDS[number % len(ROOM_KINDS)] for number in range(len(floor.rooms))]
    rng.shuffle(kinds)
    furniture = Furniture(outline, floor.solids, start)
    rooms: Dict[str, str] = {}
    tops: Dict[str, FurnitureTop] = {}
    tall = list(floor.solids)
    for number, (room, kind) in enumerate(zip(floor.rooms, kinds), 1):
        rooms[f"{kind} {number}"] = kind
        for piece in FURNITURE[kind]:
            placed = _place(piece, room, furniture, rng)
            if placed is None:
                continue
            height = KINDS[piece].size[2]
            if height > 1.2:
                tall.append(placed)
            if piece in SURFACES:
                name = f"{piece} {len(tops)} in {kind} {number}"
                pose = Pose2(placed.middle[0] - start[0], placed.middle[1] - start[1])
                size = (placed.width, placed.depth)
                tops[name] = FurnitureTop(
                    name, piece, f"{kind} {number}", pose, size, SURFACES[piece] * height
                )
    bodies = [
        wall(f"solid_{number}", each.middle[0] - start[0], each.middle[1] - start[1], each.width, each.depth)
        for number, each in enumerate([*floor.solids, *furniture.pieces])
    ]
    solids = np.array([each.corners for each in tall]) - np.array([*start, *start])
    home = SemanticMap(rooms, tops, default_priors())
    return FurnishedHome(true_map(World(f"home_{seed}", (FLOOR, *bodies))), home, solids)


def _place(kind: str, room: Rectangle, furniture: Furniture, rng: np.random.Generator):
    """Place a piece in a room, most often at a wall; return its rectangle, None without room for it."""
    gap = THICKNESS / 2.0
    for _ in range(ATTEMPTS):
        width, depth = KINDS[kind].size[:2]
        if rng.random() < 0.5:
            width, depth = depth, width
        free = (room.width - width - 2.0 * gap, room.depth - depth - 2.0 * gap)
        if min(free) <= 0.0:
            continue
        shares = rng.random(2)
        if rng.random() < AT_WALL:
            # The longer side is along the wall.
            shares[int(width > depth)] = rng.integers(2)
        piece = Rectangle(
            room.x + gap + shares[0] * free[0], room.y + gap + shares[1] * free[1], width, depth
        )
        if furniture.place(piece):
            return piece
    return None


def draw_placement(
    home: FurnishedHome, object_name: str, sigma: float, uniform: float, rng: np.random.Generator
) -> Tuple[float, float]:
    """Draw where an object truly is, by habits of the household that the searcher does not know.

    Args:
        home: The home.
        object_name: Name of the object.
        sigma: Standard deviation of the logarithm by which each weight differs from the prior's.
        uniform: Probability that the object is on any piece, whatever its kind.
        rng: Generator.

    Returns:
        Position in the map [m].
    """
    tops, prior = list(home.semantic_map.furniture.values()), home.semantic_map.objects[object_name]
    kinds, rooms = sorted({top.kind for top in tops}), sorted(set(home.semantic_map.rooms.values()))
    on = {kind: prior.on.get(kind, 0.0) * math.exp(rng.normal(0.0, sigma)) for kind in kinds}
    inside = {kind: prior.in_room.get(kind, 1.0) * math.exp(rng.normal(0.0, sigma)) for kind in rooms}
    weights = np.array([on[top.kind] * inside[home.semantic_map.rooms[top.room]] for top in tops])
    if not weights.any():
        weights[:] = 1.0
    shares = (1.0 - uniform) * weights / weights.sum() + uniform / len(tops)
    top = tops[int(rng.choice(len(tops), p=shares / shares.sum()))]
    across = (rng.uniform(-0.45, 0.45, 2) * top.size).tolist()
    where = top.pose @ Pose2(*across)
    return where.x, where.y
