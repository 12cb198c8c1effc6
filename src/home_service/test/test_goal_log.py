"""Goals given by hand."""

from home_service.judging.goal_log import GoalLog
from planar import Pose2


def test_a_goal_is_told_when_it_comes_and_when_it_is_reached():
    log = GoalLog()
    assert log.add("a", "map", Pose2(2.0, 3.0, 0.5)) == "goal 1 (2.00, 3.00, 0.50): on the way"
    line = log.end("a", True, "Goal reached.", Pose2(2.0, 3.04, 0.5))
    assert line == "goal 1 (2.00, 3.00, 0.50): reached, truly 0.040 m from it"
    told = {"goal": [2.0, 3.0, 0.5], "frame": "map", "outcome": "reached", "error": 0.04}
    assert log.result_fields() == {"goals": [told]}


def test_why_a_goal_was_given_up_is_told_and_recorded():
    log = GoalLog()
    log.add("a", "map", Pose2())
    log.add("b", "map", Pose2(1.0))
    assert log.end("a", False, "preempted", Pose2()) == "goal 1 (0.00, 0.00, 0.00): preempted"
    assert [record["outcome"] for record in log.result_fields()["goals"]] == ["preempted", "open"]


def test_goals_that_are_named_only_when_they_are_taken_end_in_their_order():
    log = GoalLog()
    log.add("", "map", Pose2(1.0))
    log.add("", "map", Pose2(2.0))
    assert log.end("x", False, "replaced", None) == "goal 1 (1.00, 0.00, 0.00): replaced"
    assert log.end("x", False, "replaced", None) is None
    assert log.end("y", True, "", Pose2(2.0)) == "goal 2 (2.00, 0.00, 0.00): reached, truly 0.000 m from it"


def test_what_is_not_known_or_known_already_is_not_told():
    log = GoalLog()
    log.add("a", "map", Pose2())
    assert log.add("a", "map", Pose2()) is None
    assert log.end("b", True, "", None) is None
    assert log.end("a", True, "", None) == "goal 1 (0.00, 0.00, 0.00): reached"
    assert log.end("a", True, "", None) is None
    assert GoalLog().result_fields() == {}
