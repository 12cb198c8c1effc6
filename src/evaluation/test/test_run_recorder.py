"""The recorder keeps a mission completely, and a bounded number of events of a long run."""

import numpy as np
import pytest

from evaluation.consumers.run_recorder import MAX_COLLISIONS, MAX_EVENTS, MAX_PLANS, RunRecorder
from evaluation.consumers.samples import MAX_SAMPLES
from evaluation.event_stream import EventStream
from evaluation.events import (
    BodiesTouched,
    CorrectionUpdated,
    GoalAccepted,
    LineLogged,
    MapPublished,
    MarkerUpdated,
    OdometryUpdated,
    PlanUpdated,
    StateUpdated,
    TruthUpdated,
)
from planar import OccupancyGrid, PlanarError, Pose2

RATE = 20


@pytest.fixture
def recorded():
    """A recorder and its events."""
    recorder, events = RunRecorder({}), EventStream()
    recorder.attach(events)
    return recorder, events


def drive(events, seconds):
    for number in range(seconds * RATE):
        events.publish(TruthUpdated(number / RATE, Pose2(number / RATE / 3.0)))


def serve(events, deliveries):
    for number in range(deliveries):
        events.publish(StateUpdated(1.0, f"going to {number}"))
        events.publish(GoalAccepted(1.0, Pose2(number)))
        for _ in range(3):
            events.publish(PlanUpdated(1.0, np.array([[float(number), 0.0]])))
        events.publish(BodiesTouched(1.0, (f"sofa {number}",)))
        events.publish(MarkerUpdated(1.0, "cup", 0, (float(number), 0.0, 0.0)))


def test_a_mission_is_recorded_completely(recorded):
    recorder, events = recorded
    drive(events, 600)
    serve(events, 20)
    record = recorder.record()
    stamps = np.arange(0, 600 * RATE, RATE // 10) / RATE
    assert np.allclose(record.truth[:, 0], stamps, rtol=0.0, atol=1e-6)
    assert np.array_equal(record.truth[:, 1], stamps / 3.0)
    kept = (record.states, record.goals, record.plans, record.collisions, record.markings)
    assert [len(events) for events in kept] == [20] * 5
    assert [plan[0, 0] for plan in record.plans] == [goal.x for goal in record.goals]


def test_only_the_latest_events_of_a_long_run_are_kept(recorded):
    recorder, events = recorded
    serve(events, 2000)
    record = recorder.record()
    assert len(record.states) == len(record.goals) == len(record.markings) == MAX_EVENTS
    assert len(record.plans) == MAX_PLANS
    assert len(record.collisions) == MAX_COLLISIONS
    assert record.states[-1].name == "going to 1999"
    assert record.plans[-1][0, 0] == record.goals[-1].x == 1999.0


def test_a_long_trajectory_is_kept_whole_with_fewer_samples(recorded):
    recorder, events = recorded
    drive(events, 2 * 3600)
    truth = recorder.record().truth
    assert MAX_SAMPLES / 2 < len(truth) <= MAX_SAMPLES
    assert truth[0, 0] == 0.0 and truth[-1, 0] > 7198.0


def test_the_estimate_is_odometry_with_its_latest_correction(recorded):
    recorder, events = recorded
    events.publish(TruthUpdated(0.0, Pose2(5.0, 5.0)))
    events.publish(OdometryUpdated(0.0, Pose2(1.0)))
    events.publish(CorrectionUpdated(0.0, Pose2(2.0, 3.0)))
    events.publish(OdometryUpdated(0.1, Pose2(1.5)))
    record = recorder.record()
    assert record.estimate.tolist() == [[0.1, 3.5, 3.0, 0.0]]
    assert record.odometry[:, :3].tolist() == [[0.0, 5.0, 5.0], [0.1, 5.5, 5.0]]


def test_the_last_map_is_converted_at_the_end_only(recorded):
    recorder, events = recorded
    grid = OccupancyGrid(np.zeros((2, 3), np.int8), 0.1, Pose2())
    events.publish(MapPublished(0.0, lambda: pytest.fail("converted")))
    events.publish(MapPublished(1.0, lambda: grid))
    assert recorder.record().grid is grid


def test_a_map_that_cannot_be_read_is_left_out_with_a_warning(recorded):
    def unreadable():
        raise PlanarError("invalid map: 3 x 3 cells with 1 values")

    recorder, events = recorded
    events.publish(MapPublished(1.5, unreadable))
    record = recorder.record()
    assert record.grid is None
    assert record.warnings == [(1.5, "report", "no map: invalid map: 3 x 3 cells with 1 values")]


def test_warnings_are_kept_and_information_is_not(recorded):
    recorder, events = recorded
    events.publish(LineLogged(1.0, "amcl", "lost", is_warning=True))
    events.publish(LineLogged(2.0, "amcl", "found"))
    assert recorder.record().warnings == [(1.0, "amcl", "lost")]
