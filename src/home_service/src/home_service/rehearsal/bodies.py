"""The solid objects of a mission as boxes in a simulation without ROS."""

from typing import List, Sequence, Set

from add_markers import Bodies, Move, Solid
from add_markers.bodies import HEIGHT, MASS, RIDING_HEIGHT
from pick_objects import Errand
from planar import OccupancyGrid, Pose2
from sim_bridge import Simulation
from sim_bridge.simulation import box_on_floor


class RehearsedBodies:
    """Moves them as the mission goes on."""

    def __init__(self, simulation: Simulation, grid: OccupancyGrid):
        self._simulation = simulation
        self._bodies = Bodies()
        self._bodies.grid = grid
        self._there: Set[str] = set()

    def follow(self, solids: Sequence[Solid], robot: Pose2) -> None:
        """Brings the boxes to where they belong; ``robot``: where it truly is now."""
        for order in self._bodies.update(solids, robot):
            if isinstance(order, Move):
                self._move(order, robot)

    def _move(self, move: Move, robot: Pose2) -> None:
        scene, name, size = (
            self._simulation.scene,
            move.solid.name,
            (move.solid.size, move.solid.size, HEIGHT),
        )
        if name in self._there:
            scene.remove_model(name)
        self._there.add(name)
        if move.pose is not None:
            scene.add([box_on_floor(name, size, move.pose, MASS)])
        else:
            scene.add([box_on_floor(name, size, robot, MASS, height=RIDING_HEIGHT)])
            scene.attach(self._simulation.base, f"{name}::link")


def solids_of(errand: Errand) -> List[Solid]:
    """The solid objects, and where they belong now."""
    things = [(errand.mission.thing(name), where) for name, where in errand.whereabouts.items()]
    return [
        Solid(thing.name, thing.size, None if where.is_carried else where.pose)
        for thing, where in things
        if thing.solid
    ]
