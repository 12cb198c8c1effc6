from explorer_lite.progress import GoalProgressChecker


def test_a_robot_without_progress_is_stuck():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    assert not watch.is_stuck(1.0, 3.0)
    assert not watch.is_stuck(9.0, 3.0)
    assert watch.is_stuck(11.0, 2.95)


def test_a_goal_that_moves_away_does_not_make_the_robot_stuck():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    assert not watch.is_stuck(1.0, 3.0)
    assert not watch.is_stuck(9.0, 0.05)
    watch.on_goal_moved()
    assert not watch.is_stuck(15.0, 1.5)
    assert not watch.is_stuck(24.0, 0.5)


def test_a_goal_that_moves_back_and_forth_does_not_hide_a_stuck_robot():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    for now in range(10):
        assert not watch.is_stuck(float(now), 2.0 + now % 2)
        watch.on_goal_moved()
    assert watch.is_stuck(11.0, 2.0)
