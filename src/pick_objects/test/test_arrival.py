"""Arrivals are accepted only where the scans fit the map."""

from pick_objects import ArrivalCheck, GoalFailed, GoalReached, RecentScanFit, ResendGoal, RobotDisplaced
from planar import Pose2

GOOD, BAD = 0.9, 0.05
GOAL, NEAR, FAR = Pose2(2.0, 3.0), Pose2(2.1, 3.0), Pose2(2.0, 3.5)


def test_an_arrival_needs_two_scans_that_fit():
    fit = RecentScanFit()
    assert fit.minimum is None
    for value, minimum in ((0.9, 0.9), (0.05, 0.05), (1.0, 0.05), (0.8, 0.8)):
        fit.add(value)
        assert fit.minimum == minimum


def test_a_robot_whose_scans_fit_or_have_no_known_fit_has_arrived():
    for fit in (GOOD, None):
        assert ArrivalCheck(GOAL).check(GoalReached(), NEAR, fit, 0.0) == GoalReached()


def test_a_confirmed_arrival_followed_by_a_scan_that_does_not_fit_is_a_displacement():
    arrival = ArrivalCheck(GOAL)
    assert arrival.check(GoalReached(), NEAR, GOOD, 0.0) == GoalReached()
    assert [arrival.check(None, NEAR, fit, 1.0) for fit in (None, GOOD, BAD, BAD)] == [
        None,
        None,
        RobotDisplaced(),
        None,
    ]


def test_a_fit_that_is_unknown_for_a_while_does_not_hide_a_displacement():
    """As after a jump of time, when no fit is fresh."""
    arrival = ArrivalCheck(GOAL)
    arrival.check(GoalReached(), NEAR, GOOD, 0.0)
    outcomes = [arrival.check(None, NEAR, fit, 1.0) for fit in (GOOD, None, BAD)]
    assert outcomes == [None, None, RobotDisplaced()]


def test_a_robot_that_has_moved_since_its_arrival_by_its_odometry_is_displaced():
    """Driven by another node's velocity commands, or reset: the scans fit all the time."""
    arrival = ArrivalCheck(GOAL)
    odometry = [Pose2(7.0, 1.0), Pose2(7.05, 1.0), Pose2(7.2, 1.0), Pose2(7.2, 1.0)]
    assert arrival.check(GoalReached(), NEAR, GOOD, 0.0, odometry[0]) == GoalReached()
    outcomes = [arrival.check(None, NEAR, GOOD, 1.0, pose) for pose in odometry[1:]]
    assert outcomes == [None, RobotDisplaced(), None]


def test_odometry_that_is_known_only_after_the_arrival_is_compared_from_then_on():
    arrival = ArrivalCheck(GOAL)
    arrival.check(GoalReached(), NEAR, None, 0.0)
    outcomes = [arrival.check(None, NEAR, None, 1.0, Pose2(x, 0.0)) for x in (3.0, 3.0, 0.0)]
    assert outcomes == [None, None, RobotDisplaced()]


def test_odometry_does_not_matter_while_the_robot_drives():
    arrival = ArrivalCheck(GOAL)
    assert arrival.check(None, FAR, GOOD, 0.0, Pose2()) is None
    assert arrival.check(GoalReached(), NEAR, GOOD, 1.0, Pose2(3.0, 0.0)) == GoalReached()
    assert arrival.check(None, NEAR, GOOD, 2.0, Pose2(3.0, 0.0)) is None


def test_an_arrival_that_was_never_confirmed_is_no_displacement():
    arrival = resent()
    assert arrival.check(GoalReached(), GOAL, BAD, 6.2) == GoalReached()
    assert [arrival.check(None, GOAL, fit, 6.3) for fit in (BAD, None, BAD)] == [None, None, None]


def test_the_outcome_of_a_goal_that_was_not_reached_is_passed_on():
    refused, arrival = GoalFailed("blocked"), ArrivalCheck(GOAL)
    assert arrival.check(None, NEAR, BAD, 0.0) is None
    assert arrival.check(refused, NEAR, BAD, 0.1) is refused


def resent(standing=GOOD, found=NEAR):
    """An arrival after standing with a fit of ``standing`` and a new start at ``found``."""
    arrival = ArrivalCheck(GOAL)
    assert arrival.check(GoalReached(), GOAL, BAD, 5.0) is None
    assert arrival.check(None, GOAL, BAD, 5.9) is None
    assert arrival.check(None, GOAL, standing, 6.0) == ResendGoal()
    assert arrival.check(None, found, standing, 6.1) is None
    return arrival


def is_rejected(outcome):
    return isinstance(outcome, GoalFailed) and "does not fit the map" in outcome.reason


def test_after_a_scan_that_does_not_fit_the_robot_stands_and_the_goal_is_sent_again():
    assert resent().check(GoalReached(), GOAL, GOOD, 6.2) == GoalReached()
    assert resent(found=FAR).check(GoalReached(), GOAL, GOOD, 9.0) == GoalReached()


def test_scans_of_a_turn_do_not_contradict_a_pose_that_was_just_confirmed():
    assert resent().check(GoalReached(), GOAL, BAD, 6.2) == GoalReached()


def test_a_second_arrival_is_rejected_if_scans_contradict_a_pose_far_away_or_never_confirmed():
    assert is_rejected(resent(found=FAR).check(GoalReached(), GOAL, BAD, 9.0))
    assert is_rejected(resent(standing=BAD).check(GoalReached(), GOAL, BAD, 6.2))


def test_a_clock_that_is_set_back_does_not_stop_the_robot_for_ever():
    arrival = ArrivalCheck(GOAL)
    arrival.check(GoalReached(), GOAL, BAD, 1000.0)
    outcomes = [arrival.check(None, GOAL, GOOD, 0.1 * tick) for tick in range(12)]
    assert ResendGoal() in outcomes
