"""Goals are judged in the frame of the project's map, wherever that lies in the world."""

import math

import pytest

from evaluation.event_stream import EventStream
from evaluation.events import EstimateUpdated, GoalEnded, GoalRequested, TruthUpdated
from planar import Pose2
from run_project.judging.map_alignment import MapAlignment
from run_project.judging.run_record import ProjectRunRecord

PATH = [Pose2(0.5 * step, 0.2 * step, 0.1 * step) for step in range(12)]
TURNED = Pose2(3.0, -2.0, math.pi / 2.0)


def aligned(frame, wrong=0, error=Pose2()):
    alignment = MapAlignment()
    for number, truth in enumerate(PATH):
        estimate = frame.inverse() @ truth @ error
        alignment.add(Pose2(9.0 + number, 9.0) if number < wrong else estimate, truth)
    return alignment.map_in_world()


def test_a_map_that_is_turned_in_the_world_is_aligned():
    found = aligned(TURNED, wrong=4, error=Pose2(0.05, 0.0, 0.01))
    assert found.distance_to(TURNED) < 0.3
    assert found.yaw == pytest.approx(TURNED.yaw, abs=0.02)


@pytest.mark.parametrize("error", [Pose2(), Pose2(1.0, 0.5), Pose2(0.0, 0.0, 0.3)])
def test_an_error_of_localization_is_not_taken_for_another_frame(error):
    assert aligned(Pose2(), error=error) == Pose2()


def test_estimates_that_agree_on_nothing_align_nothing():
    assert aligned(TURNED, wrong=9) == Pose2()


def test_few_estimates_align_nothing():
    alignment = MapAlignment()
    alignment.add(Pose2(), TURNED)
    assert alignment.map_in_world() == Pose2()


def test_goals_are_measured_in_the_frame_of_the_map():
    record, events = ProjectRunRecord(lambda line: None), EventStream()
    record.attach(events)
    goal = TURNED.inverse() @ PATH[-1]
    events.publish(GoalRequested(0.0, "goal", "map", goal))
    for truth in PATH:
        events.publish(TruthUpdated(0.0, truth))
        events.publish(EstimateUpdated(0.0, TURNED.inverse() @ truth))
    events.publish(GoalEnded(1.0, "goal", 3, ""))
    assert record.goals["goal"].distance == pytest.approx(0.0, abs=1e-6)
    assert record.findings()["map_in_world"] == [3.0, -2.0, 1.571]
