"""Boxes of a mission in a simulator: each is spawned again where it belongs whenever that changes."""

from typing import Dict, List, Protocol, Sequence, Set

from add_markers.boxes import BoxPlacer, PlaceBox, RemoveBox, SolidBox
from planar import OccupancyGrid, Pose2


class BoxSimulator(Protocol):
    """What the boxes need of a simulator."""

    def robot_in_world(self) -> Pose2:
        """Return the true pose of the robot, which is also its pose in the map."""

    def spawn(self, order: PlaceBox) -> None:
        """Spawn a box on the floor, or attached to the robot."""

    def remove(self, name: str) -> None:
        """Remove a box."""


class MissionBoxes:
    """Moves the boxes as the mission proceeds.

    Args:
        simulator: Simulator with the boxes.
    """

    def __init__(self, simulator: BoxSimulator):
        self._simulator, self._placer = simulator, BoxPlacer()
        self._latest: List[SolidBox] = []
        self._spawned: Set[str] = set()

    @property
    def placed(self) -> Dict[str, Pose2]:
        """Poses of the boxes on the floor, by name."""
        return self._placer.placed

    def set_map(self, grid: OccupancyGrid) -> None:
        """Set the map in which boxes are placed on free cells."""
        self._placer.grid = grid

    def room_beside(self, robot: Pose2, size: float) -> Pose2:
        """Return a free pose next to the robot in the map, for an object of that width [m]."""
        return self._placer.room_beside(robot, size, robot)

    def update(self, solids: Sequence[SolidBox]) -> None:
        """Move the boxes to where they belong, if that has changed.

        Args:
            solids: All solid objects of the mission.
        """
        if list(solids) == self._latest:
            return
        for order in self._placer.update(solids, self._simulator.robot_in_world()):
            name = order.name if isinstance(order, RemoveBox) else order.solid.name
            if name in self._spawned:
                self._spawned.discard(name)
                self._simulator.remove(name)
            if isinstance(order, PlaceBox):
                self._simulator.spawn(order)
                self._spawned.add(name)
        self._latest = list(solids)
