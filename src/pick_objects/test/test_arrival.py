"""A robot does not claim to have arrived where it is not, and does not despair where it is."""

from pick_objects import ArrivalCheck, GoalFailed, GoalReached, RecentScanFit, ResendGoal, RobotDisplaced
from planar import Pose2

GOOD, BAD = 0.9, 0.05
GOAL, NEAR, FAR = Pose2(2.0, 3.0), Pose2(2.1, 3.0), Pose2(2.0, 3.5)


def test_an_arrival_needs_two_scans_that_speak_for_it():
    fit = RecentScanFit()
    assert fit.minimum is None
    for value, minimum in ((0.9, 0.9), (0.05, 0.05), (1.0, 0.05), (0.8, 0.8)):
        fit.add(value)
        assert fit.minimum == minimum


def test_a_robot_that_sees_what_it_should_or_of_which_nobody_tells_has_arrived():
    for fit in (GOOD, None):
        assert ArrivalCheck(GOAL).check(GoalReached(), NEAR, fit, 0.0) == GoalReached()


def test_a_robot_that_has_arrived_and_then_sees_something_else_has_left():
    arrival = ArrivalCheck(GOAL)
    assert arrival.check(GoalReached(), NEAR, GOOD, 0.0) == GoalReached()
    assert [arrival.check(None, NEAR, fit, 1.0) for fit in (None, GOOD, BAD, BAD)] == [
        None,
        None,
        RobotDisplaced(),
        None,
    ]


def test_a_robot_that_has_never_been_sure_of_having_arrived_has_not_left():
    arrival = in_doubt()
    assert arrival.check(GoalReached(), GOAL, BAD, 6.2) == GoalReached()
    assert [arrival.check(None, GOAL, fit, 6.3) for fit in (BAD, None, BAD)] == [None, None, None]


def test_what_has_not_been_reached_is_as_it_was_told():
    refused, arrival = GoalFailed("blocked"), ArrivalCheck(GOAL)
    assert arrival.check(None, NEAR, BAD, 0.0) is None
    assert arrival.check(refused, NEAR, BAD, 0.1) is refused


def in_doubt(standing=GOOD, found=NEAR):
    """An arrival at which the robot has stood, with that fit, and set out again from ``found``."""
    arrival = ArrivalCheck(GOAL)
    assert arrival.check(GoalReached(), GOAL, BAD, 5.0) is None
    assert arrival.check(None, GOAL, BAD, 5.9) is None
    assert arrival.check(None, GOAL, standing, 6.0) == ResendGoal()
    assert arrival.check(None, found, standing, 6.1) is None
    return arrival


def has_not_arrived(told):
    return isinstance(told, GoalFailed) and "does not fit the map" in told.reason


def test_in_doubt_the_robot_stands_and_is_sent_there_again():
    assert in_doubt().check(GoalReached(), GOAL, GOOD, 6.2) == GoalReached()
    assert in_doubt(found=FAR).check(GoalReached(), GOAL, GOOD, 9.0) == GoalReached()


def test_scans_of_a_turn_do_not_speak_against_a_robot_that_has_just_been_found_there():
    assert in_doubt().check(GoalReached(), GOAL, BAD, 6.2) == GoalReached()


def test_a_robot_that_was_found_elsewhere_or_nowhere_and_sees_something_else_again_has_not_arrived():
    assert has_not_arrived(in_doubt(found=FAR).check(GoalReached(), GOAL, BAD, 9.0))
    assert has_not_arrived(in_doubt(standing=BAD).check(GoalReached(), GOAL, BAD, 6.2))


def test_a_clock_that_is_set_back_does_not_let_it_stand_for_ever():
    arrival = ArrivalCheck(GOAL)
    arrival.check(GoalReached(), GOAL, BAD, 1000.0)
    told = [arrival.check(None, GOAL, GOOD, 0.1 * tick) for tick in range(12)]
    assert ResendGoal() in told
