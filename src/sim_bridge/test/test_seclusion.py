"""A robot is asked what it touches only where there is something that it could touch."""

import numpy as np
import pytest

from planar import Twist2
from sim_bridge import ROBOTS, Simulation
from sim_bridge.courses import Course
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Cylinder, Plane
from sim_bridge.physics.motion import at_rest
from sim_bridge.physics.seclusion import extent_of
from sim_bridge.physics.vehicle import Vehicle
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import Body, Collision, World


def body(name, shape, pose, **more):
    return Body(name, pose, (Collision(shape, np.eye(4)),), **more)


SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))
FLOOR = body("floor::link", Plane(), np.eye(4))
POSTS = [
    body(f"post_{i}::link", Cylinder(0.1, 1.0), pose3(0.7 * np.cos(angle), 0.7 * np.sin(angle), 0.5))
    for i, angle in enumerate(np.arange(6.0))
]
PASSER = body("passer::link", Cylinder(0.2, 1.0), pose3(-3.0, 0.0, 0.5), is_on_course=True)
PASSES = Course(PASSER.name, np.array([0.0, 2.0, 4.0]), np.array([[-3.0, 0.0], [3.0, 0.3], [-3.0, 0.0]]))


def shares_of(monkeypatch, world, robot, seconds=20.0):
    """Drives about by chance; how often a robot was secluded, and how often it touched something.

    Each time that it is said to be secluded, it is asked what it touches all the same.
    """
    told = []
    is_secluded = Vehicle.is_secluded

    def checked(vehicle):
        told.append((is_secluded(vehicle), bool(vehicle.bumps())))
        return told[-1][0]

    monkeypatch.setattr(Vehicle, "is_secluded", checked)
    rng, simulation, turn = np.random.default_rng(5), Simulation(world, robot), Twist2(1.0)
    for _ in range(round(seconds / simulation.step_seconds)):
        if rng.random() < 0.01:
            turn = Twist2(float(rng.uniform(-1.0, 1.0)), float(rng.uniform(-2.0, 2.0)))
        simulation.step(turn)
    simulation.close()
    return np.mean(told, axis=0), [pair for pair in told if all(pair)]


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=list(ROBOTS))
def test_whoever_is_secluded_touches_nothing(robot, monkeypatch):
    (secluded, touching), wrong = shares_of(monkeypatch, World("posts", (FLOOR, *POSTS)), robot)
    assert wrong == []
    assert secluded > 0.1
    assert touching > 0.0, "it gets to a post now and then"


def test_nobody_is_secluded_from_what_is_shifted_against_them(monkeypatch):
    world = World("passer", (FLOOR, PASSER), courses=(PASSES,))
    (secluded, touching), wrong = shares_of(monkeypatch, world, ROBOTS["turtlebot_lidar"])
    assert wrong == []
    assert secluded > 0.5
    assert touching > 0.0


def test_nobody_is_secluded_where_something_else_moves(monkeypatch):
    box = body("box::link", Box((0.2, 0.2, 0.2)), pose3(3.0, 0.0, 0.1), mass=1.0)
    (secluded, _), _ = shares_of(monkeypatch, World("box", (FLOOR, box)), ROBOTS["jackal"], seconds=1.0)
    assert secluded == 0.0


def test_a_robot_put_beside_a_post_feels_it_at_once():
    simulation = Simulation(World("posts", (FLOOR, *POSTS)))
    simulation.step()
    simulation.scene.models.set_link_motion(
        simulation.base, simulation.scene.models.motion(ROBOT_NAME).at(pose3(0.5, 0.0, 0.0))
    )
    assert simulation.step().contacts == ("post_0::link",)


def test_an_extent_holds_all_of_a_robot():
    base = body("robot::base", Box((0.4, 0.2, 0.1)), np.eye(4), mass=1.0)
    wheel = body("robot::wheel", Cylinder(0.05, 0.02), pose3(0.3, 0.0, 0.0), mass=0.1)
    radius, height = extent_of([base, wheel])
    assert radius == pytest.approx(0.3 + np.hypot(0.05, 0.01) + 0.01)
    assert height == pytest.approx(np.hypot(0.05, 0.01) + 0.01)


def test_a_robot_in_the_midst_of_a_frame_is_secluded_from_it(monkeypatch):
    sides = [(pose3(2.0 * x, 2.0 * y, 0.5), (0.1 + 4.0 * abs(y), 0.1 + 4.0 * abs(x), 1.0)) for x, y in SIDES]
    frame = Body("frame::link", np.eye(4), tuple(Collision(Box(size), pose) for pose, size in sides))
    robot = ROBOTS["turtlebot_lidar"]
    (secluded, touching), wrong = shares_of(monkeypatch, World("frame", (FLOOR, frame)), robot)
    assert wrong == []
    assert secluded > 0.3
    assert touching > 0.0


def test_what_is_put_against_a_robot_is_felt_at_once():
    far = body("far::link", Box((0.2, 0.2, 0.2)), pose3(9.0, 0.0, 0.1))
    simulation = Simulation(World("far", (FLOOR, far)))
    simulation.step()
    simulation.scene.models.set_link_motion("far::link", at_rest(pose3(0.2, 0.0, 0.1)))
    assert simulation.step().contacts == ("far::link",)
