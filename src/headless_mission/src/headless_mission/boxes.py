"""Solid objects of a mission as boxes in a headless simulation."""

from typing import List, Sequence, Set

from add_markers import BoxPlacer, PlaceBox, SolidBox
from add_markers.boxes import HEIGHT, MASS, RIDING_HEIGHT
from pick_objects import Errand
from planar import OccupancyGrid, Pose2
from sim_bridge import Simulation
from sim_bridge.simulation import box_on_floor


class HeadlessBoxes:
    """Moves the boxes as the mission proceeds."""

    def __init__(self, simulation: Simulation, grid: OccupancyGrid):
        self._simulation = simulation
        self._placer = BoxPlacer()
        self._placer.grid = grid
        self._spawned: Set[str] = set()

    def update(self, solids: Sequence[SolidBox], robot: Pose2) -> None:
        """Move the boxes to where they belong.

        Args:
            solids: All solid objects.
            robot: True pose of the robot.
        """
        for order in self._placer.update(solids, robot):
            if isinstance(order, PlaceBox):
                self._place(order, robot)

    def _place(self, order: PlaceBox, robot: Pose2) -> None:
        scene, name, size = (
            self._simulation.scene,
            order.solid.name,
            (order.solid.size, order.solid.size, HEIGHT),
        )
        if name in self._spawned:
            scene.remove_model(name)
        self._spawned.add(name)
        if order.pose is not None:
            scene.add([box_on_floor(name, size, order.pose, MASS)])
        else:
            scene.add([box_on_floor(name, size, robot, MASS, height=RIDING_HEIGHT)])
            scene.attach(self._simulation.base, f"{name}::link")


def boxes_of(errand: Errand) -> List[SolidBox]:
    """Return the solid objects of an errand and where they are now."""
    objects = [(errand.mission.object_named(name), where) for name, where in errand.object_locations.items()]
    return [
        SolidBox(item.name, item.size, None if where.is_carried else where.pose)
        for item, where in objects
        if item.solid
    ]
