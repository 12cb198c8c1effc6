"""A robot that crosses a room avoids people who do not react to it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from robot_in_picture import BODY_RADIUS, PERSON_RADIUS, SETTINGS, Robot, room, scan_with_people

from move_base_lite import Navigator, Status
from planar import Pose2

START, GOAL = Pose2(1.0, 3.0), Pose2(8.0, 3.0)
ROBOT_SPEED = 0.55


class RobotAmongPeople(Robot):
    """A robot that observes one person walking straight on."""

    def __init__(self, grid, pose, person_start_xy, person_velocity):
        super().__init__(grid, pose)
        self._person = np.array(person_start_xy), np.array(person_velocity)
        self._rng = np.random.default_rng(0)
        self.gap = math.inf

    def scan(self):
        return scan_with_people(self.grid, self.pose, self.now, [self.person_xy], self._rng)

    @property
    def person_xy(self):
        start_xy, velocity = self._person
        return start_xy + self.now * velocity

    def drive(self, command):
        super().drive(command)
        apart = math.dist(self.person_xy, (self.pose.x, self.pose.y))
        self.gap = min(self.gap, apart - BODY_RADIUS - PERSON_RADIUS)


def crossing(number):
    """Start and velocity of a person on a collision course with a robot that drives straight on."""
    rng = np.random.default_rng([number, 20])
    heading, speed = rng.uniform(0.3, math.pi) * rng.choice([-1, 1]), rng.uniform(0.4, 0.9)
    velocity = speed * np.array([math.cos(heading), math.sin(heading)])
    meeting_x = rng.uniform(START.x + 2.0, GOAL.x - 2.0)
    seconds = (meeting_x - START.x) / ROBOT_SPEED + 0.8
    return np.array([meeting_x, START.y]) + rng.normal(0.0, 0.15, 2) - seconds * velocity, velocity


def drive_across(number, settings=SETTINGS):
    """Time taken [s] and smallest distance to the person [m]."""
    grid = room(9.0, 6.0)
    robot, navigator = RobotAmongPeople(grid, START, *crossing(number)), Navigator(settings, grid)
    navigator.set_goal(GOAL)
    while robot.now < 40.0:
        decision = robot.tick(navigator)
        if decision.status.is_final:
            assert decision.status is Status.SUCCEEDED, decision.text
            return robot.now, robot.gap
    raise AssertionError("goal not reached within 40 s")


@pytest.mark.parametrize("number", range(6))
def test_a_person_crossing_the_path_is_avoided(number):
    seconds, gap = drive_across(number)
    print(f"{seconds:.1f} s, {gap:.2f} m")
    assert gap > 0.1
    assert seconds < 18.0


def test_without_prediction_there_would_be_collisions():
    blind = replace(SETTINGS, controller=replace(SETTINGS.controller, predict_dynamic_obstacles=False))
    assert min(drive_across(number, blind)[1] for number in range(6)) < 0.0
