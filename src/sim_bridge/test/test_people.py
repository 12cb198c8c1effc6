"""Pedestrians walk to their goals around walls, each other and robots, deterministically."""

import numpy as np
import pytest

from planar import Pose2, Twist2
from sim_bridge import Simulation, WorldError
from sim_bridge.geometry.shapes import Plane
from sim_bridge.people.walker import Walker
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
# A hall, 8 by 6 m, with a wall across it that has a door.
HALL = (
    *(box_on_floor(f"end_{x}", (0.2, 6.0, 1.0), Pose2(x, 0.0)) for x in (-4.0, 4.0)),
    *(box_on_floor(f"side_{y}", (8.0, 0.2, 1.0), Pose2(0.0, y)) for y in (-3.0, 3.0)),
)
WALL = (
    box_on_floor("left_of_door", (0.2, 3.6, 1.0), Pose2(0.0, 1.2)),
    box_on_floor("right_of_door", (0.2, 1.2, 1.0), Pose2(0.0, -2.4)),
)


def hall(*walkers, solids=HALL):
    return World("hall", (FLOOR, *solids), walkers=walkers)


def walked(simulation, seconds, command=None):
    """Return the states of all pedestrians at each step, and the contacts."""
    rows, contacts = [], []
    for _ in range(round(seconds / simulation.step_seconds)):
        contacts += simulation.step(command).contacts
        rows.append(simulation.scene.crowd.rows)
    return np.array(rows), contacts


def person(name, *goals, **others):
    return Walker(name, np.array(goals, dtype=float), **others)


def test_a_pedestrian_walks_through_a_door_at_its_preferred_speed():
    anna = person("anna", (-2.0, 1.5), (2.0, 1.5), speed=1.2)
    rows, _ = walked(Simulation(hall(anna, solids=HALL + WALL), base_in_world=Pose2(3.0, -2.0)), 8.0)
    places = rows[:, 0, :2]
    at_wall = np.argmin(np.abs(places[:, 0]))
    assert -1.6 < places[at_wall, 1] < -0.8, "the door is there"
    assert np.hypot(*(places - (2.0, 1.5)).T).min() < 0.4
    assert 1.0 < np.median(np.hypot(*rows[:, 0, 2:4].T)) < 1.3
    assert walked(Simulation(hall(anna), base_in_world=Pose2(3.0, -2.0)), 1.0)[0].shape == (50, 1, 5)


@pytest.mark.parametrize("speed", [0.7, 1.4])
@pytest.mark.parametrize("width", [0.6, 0.9])
def test_slow_and_fast_pedestrians_pass_narrow_doors(width, speed):
    sides = (
        box_on_floor("left", (0.2, 3.0 - width / 2, 1.0), Pose2(0.0, 1.5 + width / 4)),
        box_on_floor("right", (0.2, 3.0 - width / 2, 1.0), Pose2(0.0, -1.5 - width / 4)),
    )
    anna = person("anna", (-2.0, 0.5), (2.0, 0.5), speed=speed)
    rows, contacts = walked(Simulation(hall(anna, solids=HALL + sides), base_in_world=Pose2(3.0, -2.0)), 10.0)
    assert np.hypot(*(rows[:, 0, :2] - (2.0, 0.5)).T).min() < 0.4
    assert not contacts


def test_a_pedestrian_without_progress_goes_to_its_next_goal():
    # A robot stands in the door.
    anna = person("anna", (-2.0, -1.2), (2.0, -1.2), speed=1.4)
    rows, _ = walked(Simulation(hall(anna, solids=HALL + WALL), base_in_world=Pose2(0.0, -1.2)), 20.0)
    at_door = np.hypot(*(rows[:, 0, :2] - (0.0, -1.2)).T) < 1.0
    longest = np.diff(np.flatnonzero(np.diff(np.concatenate(([0], at_door, [0])))))[::2].max() / 50.0
    assert at_door.any() and longest < 8.0


def test_two_pedestrians_that_meet_avoid_each_other():
    pair = person("anna", (-3.0, 0.0), (3.0, 0.0)), person("bert", (3.0, 0.0), (-3.0, 0.0))
    rows, _ = walked(Simulation(hall(*pair), base_in_world=Pose2(0.0, -2.5)), 6.0)
    apart = np.hypot(*(rows[:, 0, :2] - rows[:, 1, :2]).T)
    assert 0.38 < apart.min() < 1.2, "two of radius 0.2 do not touch"
    assert rows[-1, 0, 0] > 1.5 and rows[-1, 1, 0] < -1.5


def test_a_pedestrian_walks_around_a_robot_at_rest():
    anna = person("anna", (-2.0, 0.02), (2.0, 0.02))
    rows, contacts = walked(Simulation(hall(anna)), 6.0)
    assert contacts == []
    assert rows[:, 0, 0].max() > 1.5
    assert np.hypot(*rows[:, 0, :2].T).min() > 0.38


def test_a_standing_pedestrian_steps_aside_for_a_robot():
    dora = person("dora", (1.0, 0.15))
    rows, _ = walked(Simulation(hall(dora)), 6.0, Twist2(0.2, 0.0))
    assert np.abs(rows[:, 0, :2] - (1.0, 0.15)).max() > 0.1


def test_a_group_stays_together():
    trio = [person(f"kid_{n}", (-3.0, n - 1.0), (3.0, 0.0), group=1) for n in range(3)]
    rows, _ = walked(Simulation(hall(*trio), base_in_world=Pose2(0.0, -2.5)), 5.0)
    middle = rows[:, :, :2].mean(axis=1, keepdims=True)
    assert np.hypot(*(rows[:, :, :2] - middle).T).max() < 1.3


def test_pedestrians_are_scanned_and_repeat_their_walk_after_a_rewind():
    simulation = Simulation(hall(person("anna", (1.0, 0.0), (-1.0, 2.0))))
    simulation.mark()
    seen = []
    for _ in range(2):
        simulation.rewind(3)
        scans = [simulation.step() for _ in range(60)]
        seen.append(b"".join(one.scan.ranges.tobytes() for one in scans if one.scan is not None))
    first = Simulation(hall(person("anna", (1.0, 0.0), (-1.0, 2.0))), seed=3)
    ranges = next(one.scan.ranges for one in (first.step() for _ in range(60)) if one.scan is not None)
    assert seen[0] == seen[1]
    assert ranges[len(ranges) // 2] < 1.0


@pytest.mark.parametrize("goals", [[], [(np.nan, 0.0)]])
def test_a_pedestrian_without_goals_is_an_error(goals):
    with pytest.raises(WorldError, match="anna: a person needs goals"):
        person("anna", *goals)


def test_a_goal_in_a_wall_is_an_error():
    with pytest.raises(WorldError, match=r"'hall': a person cannot stand at \(4, 0\)"):
        Simulation(hall(person("anna", (0.0, 1.0), (4.0, 0.0))))
