"""The goal driver on a client of move_base whose outcomes are given."""

import pytest

from pick_objects import DriveToPlace, GoalDriver, GoalFailed, GoalReached, MeasurePathLengths, RobotDisplaced
from planar import PlanarError, Pose2
from planar.driving import DriveOutcome
from planar.maps.places import NamedPlace

SHELF = Pose2(3.0, 0.0)
REACHED = DriveOutcome("SUCCEEDED", "Goal reached.")


class Client:
    """Records goals, and returns each outcome once."""

    def __init__(self):
        self.robot, self.goals, self.next_outcome = Pose2(), [], None

    def send(self, goal):
        self.goals.append(goal)

    def outcome(self):
        outcome, self.next_outcome = self.next_outcome, None
        return outcome

    def plan_length(self, start, end):
        raise PlanarError("no answer")


@pytest.fixture
def client():
    return Client()


@pytest.fixture
def driver(client):
    driver = GoalDriver(client)
    driver.carry_out(DriveToPlace(NamedPlace("shelf", SHELF), 1))
    return driver


def test_the_outcome_of_a_goal_is_an_event_once(client, driver):
    assert client.goals == [SHELF]
    assert driver.event(1.0) is None
    client.next_outcome = REACHED
    assert driver.event(2.0) == GoalReached()
    assert driver.event(2.1) is None


def test_a_failure_is_an_event_with_its_reason(client, driver):
    client.next_outcome = DriveOutcome("ABORTED", "no path")
    assert driver.event(1.0) == GoalFailed("no path")


def test_a_goal_is_sent_again_if_the_scans_contradict_the_pose(client, driver):
    client.next_outcome = REACHED
    for tick in range(12):
        driver.add_fit(0.1 * tick, 0.01)
        assert driver.event(0.1 * tick) is None
    assert client.goals == [SHELF, SHELF]


def test_a_fit_that_is_too_old_contradicts_nothing(client, driver):
    driver.add_fit(0.0, 0.01)
    client.next_outcome = REACHED
    assert driver.event(5.0) == GoalReached()


def test_a_robot_that_moves_after_its_arrival_is_displaced(client, driver):
    driver.odometry, client.next_outcome = Pose2(), REACHED
    assert driver.event(1.0) == GoalReached()
    driver.odometry = Pose2(0.5, 0.0)
    assert driver.event(1.1) == RobotDisplaced()


def test_straight_lines_are_measured_if_move_base_does_not_plan(client, driver):
    client.robot = Pose2(0.0, 4.0)
    assert driver.carry_out(MeasurePathLengths(((None, SHELF), (SHELF, Pose2())))).lengths == (5.0, 3.0)
