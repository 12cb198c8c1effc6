"""The trace of a run has its published events, from the first goal to the last outcome."""

import json

import pytest

from evaluation.consumers.trace_recorder import TraceRecorder
from evaluation.event_stream import EventStream
from evaluation.events import (
    BodiesTouched,
    DeliveryProgress,
    GoalAccepted,
    GoalEnded,
    MarkerUpdated,
    MissionUpdated,
    OtherRobotUpdated,
    Publication,
    RemarksUpdated,
    TruthUpdated,
)
from evaluation.result import ResultFile
from pick_objects import Delivery, DeliveryStage
from planar import Pose2

SECOND = 1_000_000_000


@pytest.fixture
def events():
    return EventStream()


@pytest.fixture
def trace(events):
    recorder = TraceRecorder()
    recorder.attach(events)
    return recorder


def published(seconds, topic, rotation=(0.0, 1.0)):
    return Publication(seconds * SECOND, topic, "/a_node", rotation)


def drive(events):
    delivery = DeliveryProgress(Delivery("post", "cup", "hall", "door"), DeliveryStage.CARRYING, 1, "")
    events.publish(TruthUpdated(1.0, Pose2(), publication=published(1, "/truth")))
    events.publish(GoalAccepted(2.0, Pose2(1.5, 2.0), published(2, "/goal", (0.1, 0.9))))
    events.publish(TruthUpdated(3.0, Pose2(0.1, 0.2), publication=published(3, "/truth")))
    follower = TruthUpdated(3.0, Pose2(7.0), publication=published(3, "/follower/truth"))
    events.publish(OtherRobotUpdated(3.0, "follower", follower))
    events.publish(OtherRobotUpdated(3.0, "follower", BodiesTouched(3.0, ("sofa",))))
    events.publish(TruthUpdated(4.0, Pose2(9.0)))
    events.publish(MissionUpdated(5.0, "going", (delivery,), "", "door", 2, published(5, "/mission")))
    events.publish(MarkerUpdated(5.0, "cup", 0, (1.0, 2.0, 0.5)))
    events.publish(GoalEnded(6.0, "a", 3, "Goal reached.", published(6, "/result")))
    late = GoalEnded(8.0, "b", 3, "", published(8, "/follower/result"))
    events.publish(OtherRobotUpdated(8.0, "follower", late))


def test_the_content_of_the_trace(trace, events, tmp_path):
    drive(events)
    result = ResultFile(tmp_path)
    trace.save(result)
    assert (tmp_path / "trace.txt").read_text().splitlines() == [
        "2.000000000 /goal /a_node 1.5 2.0 0.1 0.9",
        "3.000000000 /follower/truth /a_node 7.0 0.0 0.0 1.0",
        "3.000000000 /truth /a_node 0.1 0.2 0.0 1.0",
        "5.000000000 /mission /a_node 'going' at 'door', attempt 2 (post: 3)",
        "6.000000000 /result /a_node 3 'Goal reached.'",
        "marker cup 0: 0 at 1.0 2.0 0.5",
    ]
    result.write()
    assert json.loads((tmp_path / "result.json").read_text())["repeatable"] is True


def test_remarks_are_the_reasons_why_a_run_is_not_repeatable(trace, events, tmp_path):
    drive(events)
    events.publish(RemarksUpdated(7.0, ("a node was late",)))
    result = ResultFile(tmp_path)
    trace.save(result)
    assert result.content["repeatable"] is False
    assert result.content["not_repeatable_because"] == ["a node was late"]


def test_a_run_that_has_not_driven_leaves_no_trace(trace, events, tmp_path):
    events.publish(TruthUpdated(1.0, Pose2(), publication=published(1, "/truth")))
    trace.save(ResultFile(tmp_path))
    assert not (tmp_path / "trace.txt").exists()
