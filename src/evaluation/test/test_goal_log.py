"""Log of goals that are sent by hand."""

from evaluation.consumers.goal_log import GoalLog
from evaluation.event_stream import EventStream
from evaluation.events import SUCCEEDED, GoalEnded, GoalRequested, TruthUpdated
from planar import Pose2

ABORTED = 4


class Terminal:
    """A goal log, its events and the lines that it prints."""

    def __init__(self):
        self.lines = []
        self.log = GoalLog(self.lines.append)
        self.events = EventStream()
        self.log.attach(self.events)

    def send(self, identity, pose):
        self.events.publish(GoalRequested(1.0, identity, "map", pose))

    def end(self, identity, status, text, truth):
        if truth is not None:
            self.events.publish(TruthUpdated(2.0, truth))
        before = len(self.lines)
        self.events.publish(GoalEnded(2.0, identity, status, text))
        return self.lines[before:]


def test_a_goal_is_logged_when_it_is_sent_and_when_it_is_reached():
    terminal = Terminal()
    terminal.send("a", Pose2(2.0, 3.0, 0.5))
    assert terminal.lines == ["goal 1 (2.00, 3.00, 0.50): on the way"]
    lines = terminal.end("a", SUCCEEDED, "Goal reached.", Pose2(2.0, 3.04, 0.5))
    assert lines == ["goal 1 (2.00, 3.00, 0.50): reached, truly 0.040 m from it"]
    record = {"goal": [2.0, 3.0, 0.5], "frame": "map", "outcome": "reached", "error": 0.04}
    assert terminal.log.result_fields() == {"goals": [record]}


def test_the_reason_of_a_failed_goal_is_logged_and_recorded():
    terminal = Terminal()
    terminal.send("a", Pose2())
    terminal.send("b", Pose2(1.0))
    assert terminal.end("a", ABORTED, "preempted", Pose2()) == ["goal 1 (0.00, 0.00, 0.00): preempted"]
    outcomes = [record["outcome"] for record in terminal.log.result_fields()["goals"]]
    assert outcomes == ["preempted", "open"]


def test_goals_without_an_id_end_in_the_order_in_which_they_were_sent():
    terminal = Terminal()
    terminal.send("", Pose2(1.0))
    terminal.send("", Pose2(2.0))
    assert terminal.end("x", ABORTED, "replaced", None) == ["goal 1 (1.00, 0.00, 0.00): replaced"]
    assert terminal.end("x", ABORTED, "replaced", None) == []
    lines = terminal.end("y", SUCCEEDED, "", Pose2(2.0))
    assert lines == ["goal 2 (2.00, 0.00, 0.00): reached, truly 0.000 m from it"]


def test_unknown_results_and_repeated_goals_are_not_logged():
    terminal = Terminal()
    terminal.send("a", Pose2())
    terminal.send("a", Pose2())
    assert len(terminal.lines) == 1
    assert terminal.end("b", SUCCEEDED, "", None) == []
    assert terminal.end("a", SUCCEEDED, "", None) == ["goal 1 (0.00, 0.00, 0.00): reached"]
    assert terminal.end("a", SUCCEEDED, "", None) == []
    assert GoalLog(print).result_fields() == {}
