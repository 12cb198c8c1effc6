"""An interrupted errand resumes from its checkpoint."""

import json

import pytest

from pick_objects import (
    Delivery,
    DeliveryStage,
    DriveToPlace,
    Errand,
    ErrandState,
    FinishTask,
    GoalReached,
    Mission,
    checkpoint_of,
    errand_mission,
    resume_errand,
)
from pick_objects.checkpoint import CheckpointError
from planar import Pose2
from planar.maps.places import NamedPlace

A, B, C = (NamedPlace(name, Pose2(x, 0.0)) for name, x in (("a", 1.0), ("b", 2.0), ("c", 3.0)))
PLACES = {place.name: place for place in (A, B, C)}
FIRST, SECOND = Delivery("first", "cup", "a", "b"), Delivery("second", "book", "b", "c", after=("first",))
MISSION = Mission("tidy up", PLACES, (FIRST, SECOND))


def taken_up(errand):
    return resume_errand(MISSION, json.loads(json.dumps(checkpoint_of(errand))))


def carry(errand, now=0.0):
    """Drives until the object of the delivery in progress is on the robot."""
    errand.advance(now)
    errand.advance(now + 1.0, GoalReached())
    assert errand.advance(now + 10.0) is not None
    assert errand.job.stage is DeliveryStage.CARRYING


def test_an_object_on_the_robot_is_delivered_after_a_restart():
    errand = Errand(MISSION)
    carry(errand)
    again = taken_up(errand)
    assert again.object_locations["cup"].is_carried
    assert again.advance(20.0) == DriveToPlace(B, 1)
    assert again.advance(30.0, GoalReached()) == DriveToPlace(B, 1)  # where the second begins
    assert [job.stage for job in again.jobs] == [DeliveryStage.DELIVERED, DeliveryStage.FETCHING]


@pytest.mark.parametrize("event", [None, GoalReached()])
def test_an_object_that_was_not_on_the_robot_is_fetched_again(event):
    errand = Errand(MISSION)
    errand.advance(0.0)
    errand.advance(1.0, event)
    again = taken_up(errand)
    assert again.advance(20.0) == DriveToPlace(A, 1)
    assert again.job.attempts == 2


def test_a_completed_delivery_stays_completed_after_a_restart():
    errand = Errand(MISSION)
    carry(errand)
    errand.advance(20.0, GoalReached())
    errand.advance(30.0)
    again = taken_up(errand)
    carry(again, 40.0)
    assert again.advance(60.0, GoalReached()) == FinishTask(True, "2 of 2 delivered")


def test_an_added_delivery_survives_a_restart():
    errand = Errand(MISSION)
    errand.add(Delivery("", "cup", "b", "c"))
    assert [job.delivery.name for job in taken_up(errand).jobs] == ["first", "second", "delivery 3"]


def test_a_checkpoint_of_another_mission_is_ignored():
    assert resume_errand(errand_mission(A, B), checkpoint_of(Errand(MISSION))) is None


def test_after_a_restart_an_added_delivery_may_still_be_cancelled_without_failing_the_mission():
    errand = Errand(errand_mission(A, B))
    errand.add(Delivery("more", "cup", "a", "b"))
    again = resume_errand(errand_mission(A, B), json.loads(json.dumps(checkpoint_of(errand))))
    carry(again)
    again.cancel("more")
    again.advance(20.0, GoalReached())
    assert again.advance(30.0) is None
    assert again.state is ErrandState.DELIVERED


RECORD = json.loads(json.dumps(checkpoint_of(Errand(MISSION))))
JOB, WHERE = RECORD["jobs"][0], RECORD["object_locations"]["cup"]


@pytest.mark.parametrize(
    "record",
    [
        "carrying",
        [],
        {},
        {"mission": MISSION.name},
        {**RECORD, "jobs": None},
        {**RECORD, "jobs": [7]},
        {**RECORD, "jobs": [*RECORD["jobs"], JOB]},
        {**RECORD, "jobs": [{**JOB, "stage": "LOST"}, RECORD["jobs"][1]]},
        {**RECORD, "jobs": [{**JOB, "stage": "CARRYING"}, RECORD["jobs"][1]]},
        {**RECORD, "jobs": [{**JOB, "attempts": "many"}, RECORD["jobs"][1]]},
        {**RECORD, "jobs": [{**JOB, "reason": 3}, RECORD["jobs"][1]]},
        {
            **RECORD,
            "jobs": [*RECORD["jobs"], {**JOB, "delivery": {**JOB["delivery"], "name": "x", "after": ["y"]}}],
        },
        {**RECORD, "object_locations": {"cup": 1}},
        {**RECORD, "object_locations": {"cup": {**WHERE, "is_carried": True}}},
        {**RECORD, "object_locations": {"cup": {**WHERE, "place": 5}}},
        {**RECORD, "object_locations": {"cup": {**WHERE, "pose": {"x": "a", "y": 0.0, "yaw": 0.0}}}},
        {**RECORD, "object_locations": {"cup": {**WHERE, "pose": {"x": 1e400, "y": 0.0, "yaw": 0.0}}}},
    ],
)
def test_a_checkpoint_of_another_shape_is_a_checkpoint_error(record):
    with pytest.raises(CheckpointError):
        resume_errand(MISSION, record)
