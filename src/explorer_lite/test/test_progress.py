from explorer_lite.progress import GoalProgressChecker


def test_a_robot_is_stuck_that_comes_no_nearer_to_its_goal():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    assert not watch.is_stuck(1.0, 3.0)
    assert not watch.is_stuck(9.0, 3.0)
    assert watch.is_stuck(11.0, 2.95)


def test_a_robot_on_its_way_to_a_goal_that_has_moved_away_is_not():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    assert not watch.is_stuck(1.0, 3.0)
    assert not watch.is_stuck(9.0, 0.05)
    watch.on_goal_moved()
    assert not watch.is_stuck(15.0, 1.5)
    assert not watch.is_stuck(24.0, 0.5)


def test_a_goal_that_moves_about_does_not_hide_that_the_robot_is_stuck():
    watch = GoalProgressChecker(10.0)
    watch.restart(0.0)
    for now in range(10):
        assert not watch.is_stuck(float(now), 2.0 + now % 2)
        watch.on_goal_moved()
    assert watch.is_stuck(11.0, 2.0)
