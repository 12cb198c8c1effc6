"""Solid objects of a mission as boxes: where each is placed, and when it is on the robot."""

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple, Union

from planar import Pose2
from planar.geometry.grid import FREE, OccupancyGrid

# Distance from the robot's centre to the edge of a box beside it, so that the robot can turn [m].
GAP = 0.4
MARGIN = 0.05
# Directions in which a box is placed, relative to the robot's heading; those in front first.
ANGLES = [math.radians(side * angle) for angle in range(0, 181, 30) for side in (1, -1)]
# Height of a box: lower ones are below some lasers [m].
HEIGHT = 0.4
# Mass of a box, too light to disturb a TurtleBot [kg].
MASS = 0.3
# Width of a TurtleBot, and height of what it carries, just above its top [m].
ROBOT_SIZE, RIDING_HEIGHT = 0.36, 0.43


@dataclass(frozen=True)
class SolidBox:
    """A solid object.

    Attributes:
        name: Name of the object.
        size: Width [m].
        pose: Pose of the place where it is, in the map; None while it is carried.
    """

    name: str
    size: float
    pose: Optional[Pose2]


@dataclass(frozen=True)
class PlaceBox:
    """Order: place a box on the floor or on the robot.

    Attributes:
        solid: The box.
        pose: Pose on the floor in the map; None: on the robot.
    """

    solid: SolidBox
    pose: Optional[Pose2]


@dataclass(frozen=True)
class RemoveBox:
    """Order: remove a box.

    Attributes:
        name: Name of the box.
    """

    name: str


Order = Union[PlaceBox, RemoveBox]


class BoxPlacer:
    """Finds room for the boxes of a mission.

    Attributes:
        grid: Map in which boxes are placed on free cells; None: anywhere.
        placed: Poses of the boxes on the floor, by name.
    """

    def __init__(self) -> None:
        self.grid: Optional[OccupancyGrid] = None
        self.placed: Dict[str, Pose2] = {}
        self._solids: Dict[str, SolidBox] = {}

    def update(self, solids: Sequence[SolidBox], robot: Pose2) -> List[Order]:
        """Compare the boxes with those of the last call and return the orders that make them true.

        Args:
            solids: All solid objects of the mission.
            robot: Pose of the robot in the map.
        """
        gone = set(self._solids) - {solid.name for solid in solids}
        orders: List[Order] = [RemoveBox(name) for name in sorted(gone)]
        for name in gone:
            del self._solids[name]
            self.placed.pop(name, None)
        for solid in solids:
            before = self._solids.get(solid.name)
            if before == solid:
                continue
            self._solids[solid.name] = solid
            self.placed.pop(solid.name, None)
            if solid.pose is not None:
                was_carried = before is not None and before.pose is None
                beside = robot if was_carried else solid.pose
                self.placed[solid.name] = self.room_beside(beside, solid.size, robot)
            orders.append(PlaceBox(solid, self.placed.get(solid.name)))
        return orders

    def room_beside(self, pose: Pose2, size: float, robot: Pose2) -> Pose2:
        """Return a free pose next to a robot at ``pose``; the one in front of it if none is free.

        Args:
            pose: Pose of a place in the map.
            size: Width of the object that is to stand beside it [m].
            robot: Pose of the robot in the map, which is not free either.
        """
        others = [(at, self._solids[name].size) for name, at in self.placed.items()]
        others.append((robot, ROBOT_SIZE))
        places = [pose @ Pose2(0.0, 0.0, angle) @ Pose2(GAP + size / 2.0, 0.0) for angle in ANGLES]
        return next((place for place in places if self._has_room(place, size, others)), places[0])

    def _has_room(self, place: Pose2, size: float, others: Sequence[Tuple[Pose2, float]]) -> bool:
        if any(place.distance_to(pose) < (size + other) / math.sqrt(2.0) + MARGIN for pose, other in others):
            return False
        reach = size / 2.0 + MARGIN
        offsets = (-reach, 0.0, reach)
        points = [place @ Pose2(x, y) for x in offsets for y in offsets]
        return self.grid is None or all(self.grid.value_at(point.x, point.y) == FREE for point in points)
