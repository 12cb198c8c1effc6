"""Objects that are bodies in the simulator: where each stands, and when it rides on the robot."""

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple, Union

from planar import Pose2
from planar.geometry.grid import FREE, OccupancyGrid

GAP = 0.4
"""Between the middle of the robot and the box that it picks up or has set down, metres: room to turn."""
MARGIN = 0.05
ANGLES = [math.radians(side * angle) for angle in range(0, 181, 30) for side in (1, -1)]
"""To the sides of where the robot faces, those in front first."""
HEIGHT = 0.4
"""Of a box, metres: lower ones are not seen by every laser, and run over."""
MASS = 0.3
"""Of a box, kilograms: less than a TurtleBot notices."""
ROBOT_SIZE, RIDING_HEIGHT = 0.36, 0.43
"""How wide a TurtleBot is, and the height of what it carries, a little above its top, metres."""


@dataclass(frozen=True)
class SolidBox:
    """A box ``size`` metres wide; ``pose``: of the place where it is, None while it is carried."""

    name: str
    size: float
    pose: Optional[Pose2]


@dataclass(frozen=True)
class PlaceBox:
    """Order: the box is to stand at ``pose`` on the floor, or, if that is None, to ride on the robot."""

    solid: SolidBox
    pose: Optional[Pose2]


@dataclass(frozen=True)
class RemoveBox:
    """Order: the box is to be taken away."""

    name: str


Order = Union[PlaceBox, RemoveBox]


class BoxPlacer:
    """Follows a mission's boxes. ``grid``: a map of where they may stand; ``standing``: those that do."""

    def __init__(self) -> None:
        self.grid: Optional[OccupancyGrid] = None
        self.placed: Dict[str, Pose2] = {}
        self._solids: Dict[str, SolidBox] = {}

    def update(self, solids: Sequence[SolidBox], robot: Pose2) -> List[Order]:
        """What is to be done now that the mission stands so; ``robot``: where it is in the map."""
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
                has_ridden = before is not None and before.pose is None
                beside = robot if has_ridden else solid.pose
                self.placed[solid.name] = self._place_beside(beside, solid.size, robot)
            orders.append(PlaceBox(solid, self.placed.get(solid.name)))
        return orders

    def _place_beside(self, pose: Pose2, size: float, robot: Pose2) -> Pose2:
        """Where a box has room next to a robot at ``pose``, be it there or not; in front of it if nowhere."""
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
