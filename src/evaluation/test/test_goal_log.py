"""Log of goals that are sent by hand."""

from evaluation.goal_log import GoalLog
from planar import Pose2


def test_a_goal_is_logged_when_it_is_sent_and_when_it_is_reached():
    log = GoalLog()
    assert log.add("a", "map", Pose2(2.0, 3.0, 0.5)) == "goal 1 (2.00, 3.00, 0.50): on the way"
    line = log.end("a", True, "Goal reached.", Pose2(2.0, 3.04, 0.5))
    assert line == "goal 1 (2.00, 3.00, 0.50): reached, truly 0.040 m from it"
    record = {"goal": [2.0, 3.0, 0.5], "frame": "map", "outcome": "reached", "error": 0.04}
    assert log.result_fields() == {"goals": [record]}


def test_the_reason_of_a_failed_goal_is_logged_and_recorded():
    log = GoalLog()
    log.add("a", "map", Pose2())
    log.add("b", "map", Pose2(1.0))
    assert log.end("a", False, "preempted", Pose2()) == "goal 1 (0.00, 0.00, 0.00): preempted"
    assert [record["outcome"] for record in log.result_fields()["goals"]] == ["preempted", "open"]


def test_goals_without_an_id_end_in_the_order_in_which_they_were_sent():
    log = GoalLog()
    log.add("", "map", Pose2(1.0))
    log.add("", "map", Pose2(2.0))
    assert log.end("x", False, "replaced", None) == "goal 1 (1.00, 0.00, 0.00): replaced"
    assert log.end("x", False, "replaced", None) is None
    assert log.end("y", True, "", Pose2(2.0)) == "goal 2 (2.00, 0.00, 0.00): reached, truly 0.000 m from it"


def test_unknown_results_and_repeated_goals_are_not_logged():
    log = GoalLog()
    log.add("a", "map", Pose2())
    assert log.add("a", "map", Pose2()) is None
    assert log.end("b", True, "", None) is None
    assert log.end("a", True, "", None) == "goal 1 (0.00, 0.00, 0.00): reached"
    assert log.end("a", True, "", None) is None
    assert GoalLog().result_fields() == {}
