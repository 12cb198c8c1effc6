"""Doors close and open on schedule, wait for robots and open for pedestrians, deterministically."""

import numpy as np
import pytest

from planar import Pose2, Twist2
from sim_bridge import Simulation, WorldError
from sim_bridge.doorway import Door
from sim_bridge.geometry.shapes import Plane
from sim_bridge.people.walker import Walker
from sim_bridge.simulation import box_on_floor
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
# Two rooms, 4 by 4 m each, and a doorway at the origin between them.
WALLS = (
    *(box_on_floor(f"end_{x}", (0.2, 4.0, 1.0), Pose2(x, 0.0)) for x in (-4.0, 4.0)),
    *(box_on_floor(f"side_{y}", (8.0, 0.2, 1.0), Pose2(0.0, y)) for y in (-2.0, 2.0)),
    *(box_on_floor(f"beside_door_{y}", (0.1, 1.5, 1.0), Pose2(0.0, y)) for y in (-1.25, 1.25)),
)
DOORWAY, LEFT = Pose2(0.0, 0.0, 0.0), Pose2(-2.0, 0.0)


def simulated(*doors, start=LEFT, walkers=()):
    return Simulation(World("rooms", (FLOOR, *WALLS), walkers=walkers, doors=doors), base_in_world=start)


def ahead(simulation, until, command=None):
    """Return stamps and the range of the laser straight ahead."""
    seen = []
    while not seen or seen[-1][0] < until:
        observation = simulation.step(command)
        if observation.scan is not None:
            ranges = observation.scan.ranges
            seen.append((observation.stamp, float(ranges[len(ranges) // 2])))
    return np.array(seen)


def test_a_closed_door_is_scanned():
    seen = ahead(simulated(Door("door", DOORWAY, 1.0, 1.0, 2.0)), 3.0)
    is_closed = (seen[:, 0] > 1.2) & (seen[:, 0] < 2.0)
    is_open = (seen[:, 0] < 1.0) | (seen[:, 0] > 2.2)
    assert is_closed.sum() > 3 and is_open.sum() > 5
    assert (np.abs(seen[is_closed, 1] - 2.0) < 0.3).all()
    assert (seen[is_open, 1] > 5.0).all()


def test_a_door_that_is_closed_at_the_start_opens():
    seen = ahead(simulated(Door("door", DOORWAY, 1.0, end=1.0)), 2.0)
    assert seen[0, 1] < 2.3 and seen[-1, 1] > 5.0


def test_a_door_is_solid_and_not_on_the_map():
    simulation = simulated(Door("door", DOORWAY, 1.0))
    contacts = [name for _ in range(500) for name in simulation.step(Twist2(0.5, 0.0)).contacts]
    assert set(contacts) == {"door::link"}
    world = World("rooms", (FLOOR, *WALLS), doors=(Door("door", DOORWAY, 1.0),))
    grid = true_map(world, inside=(-2.0, 0.0))
    ((row, col),) = grid.cells_of([[0.0, 0.0]])
    assert grid.cells[row, col] == 0


def test_a_door_does_not_close_on_a_robot():
    simulation = simulated(Door("door", DOORWAY, 1.0, 1.0), start=DOORWAY)
    assert all(simulation.step().contacts == () for _ in range(100))
    drives = [simulation.step(Twist2(0.5, 0.0)).contacts for _ in range(200)]
    assert all(contacts == () for contacts in drives)
    backwards = ahead(simulation, simulation.scene.stamp + 4.0, Twist2(0.0, 1.0))
    assert backwards[:, 1].min() < 2.5 and len(backwards) > 10


def test_a_closed_door_opens_for_pedestrians():
    anna = Walker("anna", np.array([(-3.0, 1.0), (3.0, 1.0)]), speed=1.0)
    simulation = simulated(Door("door", DOORWAY, 1.0), start=Pose2(-1.6, -1.0), walkers=(anna,))
    was_closed, at_door = [], []
    for _ in range(400):
        simulation.step()
        x, y = simulation.scene.crowd.rows[0, :2]
        is_closed = simulation.scene.models.link_state("door::link").pose[0, 3] == 0.0
        (at_door if abs(x) < 0.5 else was_closed).append(is_closed)
    assert at_door and not any(at_door), "the pedestrian passes it while it is open"
    assert was_closed[0] and was_closed[-1], "it closes afterwards"


def test_doors_repeat_their_schedule_after_a_rewind():
    simulation = simulated(Door("door", DOORWAY, 1.0, 0.5, 1.5))
    simulation.mark()
    runs = []
    for _ in range(2):
        simulation.rewind(3)
        runs.append(ahead(simulation, 2.5).tobytes())
    assert runs[0] == runs[1]


@pytest.mark.parametrize("wrong", [{"width": 0.0}, {"start": 2.0, "end": 1.0}, {"pose": Pose2(np.nan, 0.0)}])
def test_values_of_a_door_that_are_not_valid_are_errors(wrong):
    with pytest.raises(WorldError, match="door: a door needs a valid pose"):
        Door("door", **{"pose": DOORWAY, "width": 1.0, **wrong})
