"""A follower stays behind its leader, on the leader's path."""

import math

import pytest

from follow_me import FollowSettings, LeaderFollower
from planar import Pose2

GAP, SLACK = 0.8, 0.2
BEHIND = Pose2(-1.0, 0.0, 0.0)


def follower():
    return LeaderFollower(FollowSettings(gap=GAP, slack=SLACK))


def test_a_leader_that_is_near_is_not_followed():
    assert follower().goal(Pose2(), Pose2(-0.5, 0.0, 0.0)) is None


def test_a_leader_that_goes_round_a_near_follower_is_kept_in_view():
    here = Pose2(1.0, 2.0, 0.0)
    goal = follower().goal(Pose2(1.0, 2.5, 0.0), here)
    assert (goal.x, goal.y, goal.yaw) == pytest.approx((1.0, 2.0, math.pi / 2))


def test_a_follower_that_stands_sets_off_when_the_leader_is_farther_than_gap_and_slack():
    guide, here = follower(), Pose2()
    assert guide.goal(Pose2(GAP + SLACK - 0.01, 0.0, 0.0), here) is None
    assert guide.goal(Pose2(GAP + SLACK + 0.01, 0.0, 0.0), here) is not None
    assert guide.goal(Pose2(GAP + 0.5 * SLACK, 0.0, 0.0), here).x == pytest.approx(0.5 * SLACK)


def test_a_leader_that_stands_is_approached_in_a_line_up_to_the_gap():
    goal = follower().goal(Pose2(3.0, 0.0, 2.0), Pose2(1.0, 0.0, 0.0))
    assert (goal.x, goal.y, goal.yaw) == pytest.approx((3.0 - GAP, 0.0, 0.0))


def test_the_goal_lies_on_the_leaders_path_behind_it_and_looks_at_it():
    guide = follower()
    for step in range(61):  # 3 m straight on, then 3 m to the left
        guide.goal(Pose2(0.05 * step, 0.0, 0.0), BEHIND)
    last = None
    for step in range(1, 61):
        last = guide.goal(Pose2(3.0, 0.05 * step, math.pi / 2), BEHIND) or last
    assert last.x == pytest.approx(3.0) and last.yaw == pytest.approx(math.pi / 2)
    assert 3.0 - last.y == pytest.approx(GAP, abs=FollowSettings().goal_shift + 0.1)


def test_a_goal_is_sent_again_only_when_it_has_moved():
    guide = follower()
    assert guide.goal(Pose2(3.0, 0.0, 0.0), BEHIND) is not None
    assert guide.goal(Pose2(3.01, 0.0, 0.0), BEHIND) is None
    assert guide.goal(Pose2(3.5, 0.0, 0.0), BEHIND) is not None


def test_a_leader_that_turns_round_is_not_run_into():
    guide = follower()
    for step in range(20):
        guide.goal(Pose2(0.1 * step, 0.0, 0.0), BEHIND)
    for step in range(20):
        leader = Pose2(2.0 - 0.1 * step, 0.0, math.pi)
        goal = guide.goal(leader, BEHIND)
        assert goal is None or goal.distance_to(leader) > 0.5 * GAP


@pytest.mark.parametrize("step, ahead", [(0.05, 0.1), (0.1, 0.2), (0.3, 0.3 * GAP)])
def test_behind_a_leader_that_goes_on_the_goal_is_where_the_gap_soon_will_be(step, ahead):
    guide = follower()
    for number in range(round(3.0 / step)):
        leader = Pose2(step * number, 0.0, 0.0)
        goal = guide.goal(leader, BEHIND)
        if goal is not None and leader.x > 1.0:
            assert GAP - ahead - 1e-9 <= leader.x - goal.x < GAP - ahead + step
    stands = guide.goal(leader, BEHIND)
    assert stands is None or GAP - 1e-9 <= leader.x - stands.x < GAP + step
