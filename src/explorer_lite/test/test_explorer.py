import math

import pytest

from explorer_lite import (
    Explorer,
    ExplorerSettings,
    ExplorerState,
    FinishTask,
    GoalFailed,
    GoalReached,
    SendGoal,
)
from planar import Pose2, SettingsError, grid_from_picture

SETTINGS = ExplorerSettings(
    clearance=0.4, goal_clearance=0.4, progress_timeout=20.0, map_patience=6.0, attempts=2
)
ROBOT = Pose2(1.25, 1.25)

# Half a metre a cell; the robot stands in the lower left corner.
CLOSED = """
##########
#........#
#........#
#........#
##########
"""
OPEN_TO_THE_RIGHT = """
#######???
#......???
#......???
#......???
#######???
"""
OPEN_AT_BOTH_ENDS = """
############
............
############
"""


def grid(picture):
    return grid_from_picture(picture, resolution=0.5)


def explorer(return_to_start=True, **settings):
    return Explorer(ExplorerSettings(**{**vars(SETTINGS), **settings}), return_to_start)


def test_a_restarted_explorer_returns_to_the_start_of_the_earlier_one():
    start = Pose2(2.25, 1.25)
    task = Explorer(SETTINGS, start=start)
    task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    assert task.advance(5.0, grid(CLOSED), Pose2(3.0, 1.25)) == SendGoal(start)
    assert task.start == start


def test_the_robot_is_sent_to_the_frontier_and_back_when_the_map_is_complete():
    task = explorer()
    order = task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    assert isinstance(order, SendGoal)
    assert order.pose.x == pytest.approx(3.25)
    assert task.advance(0.5, None, ROBOT) is None
    assert task.advance(5.0, grid(CLOSED), Pose2(3.0, 1.25)) == SendGoal(ROBOT)
    assert task.state is ExplorerState.RETURNING
    end = task.advance(20.0, None, ROBOT, GoalReached())
    assert end == FinishTask(True, "explored 6.0 m2")
    assert task.state is ExplorerState.DONE
    assert task.advance(21.0, None, ROBOT) is None


def test_a_robot_with_a_narrow_field_of_view_turns_before_it_drives():
    task = explorer(field_of_view=1.0, reach=2.0)
    order = task.advance(0.0, grid(OPEN_TO_THE_RIGHT), Pose2(2.25, 1.25, math.pi))
    assert (order.pose.x, order.pose.y) == (2.25, 1.25)
    assert order.pose.yaw == pytest.approx(0.0)
    # The turn has shown nothing new; now a nearer viewpoint is needed.
    order = task.advance(20.0, grid(OPEN_TO_THE_RIGHT), Pose2(2.25, 1.25), GoalReached())
    order = order or task.advance(30.0, grid(OPEN_TO_THE_RIGHT), Pose2(2.25, 1.25))
    assert order.pose.x == pytest.approx(3.25)


def test_without_return_to_start_it_ends_when_the_map_is_complete():
    assert explorer(return_to_start=False).advance(0.0, grid(CLOSED), ROBOT) == FinishTask(
        True, "explored 6.0 m2"
    )


def test_nothing_is_ordered_before_there_is_a_map():
    assert explorer().advance(0.0, None, ROBOT) is None


@pytest.mark.parametrize("robot_x, goal_x", [(2.0, 0.25), (4.0, 5.75)])
def test_the_nearer_of_two_frontiers_is_first(robot_x, goal_x):
    task = explorer(orientation_scale=0.0)
    order = task.advance(0.0, grid(OPEN_AT_BOTH_ENDS), Pose2(robot_x, 0.75))
    assert order.pose.x == pytest.approx(goal_x)


def test_the_present_frontier_is_only_left_for_a_much_cheaper_one():
    task = explorer(orientation_scale=0.0, switch_gain=1.0)
    corridor = grid(OPEN_AT_BOTH_ENDS)
    assert task.advance(0.0, corridor, Pose2(2.75, 0.75)).pose.x == pytest.approx(0.25)
    assert task.advance(1.0, corridor, Pose2(3.25, 0.75)) is None
    assert task.advance(2.0, corridor, Pose2(3.75, 0.75)).pose.x == pytest.approx(5.75)


def test_a_persistent_frontier_is_tried_from_elsewhere_and_then_dropped():
    task = explorer(return_to_start=False)
    room = grid(OPEN_TO_THE_RIGHT)
    first = task.advance(0.0, room, ROBOT)
    assert task.advance(10.0, None, first.pose, GoalReached()) is None
    second = task.advance(12.0, room, first.pose)
    assert second.pose.distance_to(first.pose) > SETTINGS.blacklist_radius
    assert task.advance(20.0, None, second.pose, GoalReached()) is None
    end = task.advance(22.0, room, second.pose)
    assert end == FinishTask(True, "explored 4.5 m2, 1 unreachable frontier left")
    assert len(task.unreachable) == 1


def test_at_a_goal_the_explorer_waits_for_a_map_for_a_limited_time():
    task = explorer()
    first = task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    task.advance(10.0, None, first.pose, GoalReached())
    assert task.advance(10.5, grid(OPEN_TO_THE_RIGHT), first.pose) is None
    assert task.advance(15.9, None, first.pose) is None
    assert isinstance(task.advance(16.0, None, first.pose), SendGoal)


def test_a_refused_goal_is_followed_by_another_at_once():
    task = explorer()
    first = task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    second = task.advance(5.0, None, ROBOT, GoalFailed("Failed to find a valid plan."))
    assert second.pose.distance_to(first.pose) > SETTINGS.blacklist_radius


def test_a_goal_without_progress_is_dropped():
    task = explorer()
    room = grid(OPEN_TO_THE_RIGHT)
    first = task.advance(0.0, room, ROBOT)
    orders = [task.advance(float(second), room, ROBOT) for second in range(1, 23)]
    assert orders[:19] == [None] * 19
    (second,) = filter(None, orders)
    assert second.pose.distance_to(first.pose) > SETTINGS.blacklist_radius


def test_a_stranded_robot_ends_the_exploration():
    task = explorer(attempts=100, blacklist_radius=0.1)
    task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    orders = [task.advance(1.0 + i, None, ROBOT, GoalFailed("blocked")) for i in range(8)]
    assert orders[-1] == FinishTask(False, "the robot is stuck, all goals from here were refused: blocked")


def test_a_frontier_that_appears_during_the_return_is_explored_too():
    task = explorer()
    task.advance(0.0, grid(CLOSED), Pose2(1.25, 1.25))
    order = task.advance(5.0, grid(OPEN_TO_THE_RIGHT), Pose2(1.75, 1.25))
    assert isinstance(order, SendGoal)
    assert task.state is ExplorerState.EXPLORING


def test_the_return_is_tried_again_before_it_fails():
    task = explorer(attempts=2)
    task.advance(0.0, grid(CLOSED), ROBOT)
    assert task.advance(1.0, None, ROBOT, GoalFailed("blocked")) == SendGoal(ROBOT)
    assert task.advance(2.0, None, ROBOT, GoalFailed("blocked")) == SendGoal(ROBOT)
    end = task.advance(3.0, None, ROBOT, GoalFailed("blocked"))
    assert end == FinishTask(False, "explored 6.0 m2, but the robot cannot return to the start: blocked")


def test_a_robot_in_no_free_space_waits_for_a_better_map_for_a_limited_time():
    task = explorer()
    unknown = grid("?????\n?????\n?...?")
    assert task.advance(0.0, unknown, Pose2(10.0, 10.0)) is None
    assert task.advance(19.0, unknown, Pose2(10.0, 10.0)) is None
    end = task.advance(21.0, unknown, Pose2(10.0, 10.0))
    assert end == FinishTask(False, "the map shows no free space around the robot")


def test_a_robot_that_took_long_to_arrive_still_waits_for_the_map():
    task = explorer()
    order = task.advance(0.0, grid(OPEN_AT_BOTH_ENDS), ROBOT)
    assert task.advance(19.0, None, order.pose, GoalReached()) is None
    order = task.advance(21.0, grid(OPEN_AT_BOTH_ENDS), order.pose)
    assert isinstance(order, SendGoal)


@pytest.mark.parametrize("name, value", [("attempts", 0), ("reach", 0.0), ("max_frontier_size", 0.1)])
def test_invalid_settings_are_refused(name, value):
    with pytest.raises(SettingsError, match=name):
        ExplorerSettings(**{name: value})


def test_a_clock_that_jumps_back_and_forth_does_not_stop_the_exploration():
    task = explorer()
    task.advance(0.0, grid(OPEN_TO_THE_RIGHT), ROBOT)
    task.advance(1e6, grid(OPEN_TO_THE_RIGHT), ROBOT)
    assert task.advance(5.0, grid(CLOSED), Pose2(3.0, 1.25)) is None
    assert task.advance(10.0, None, Pose2(3.0, 1.25)) == SendGoal(ROBOT)
