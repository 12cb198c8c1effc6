"""Judging of searches: by where objects truly are, not by what the robot reports."""

import pytest

from evaluation.delivery_monitor import DeliveryMonitor
from evaluation.events import MarkerUpdated
from evaluation.marker_log import MarkerLog
from evaluation.verdict import ERRAND, OBJECTS, MissionRecord, judge, true_places
from pick_objects import Delivery, DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace
from planar.maps.semantic_map import PlacedObject

CUP = PlacedObject("cup", 5.0, 2.0, 0.8)
PLACES = {**true_places([CUP]), "desk": NamedPlace("desk", Pose2(0.0, 0.0))}
FIND, FETCH = Delivery("find", "cup", "", ""), Delivery("fetch", "cup", "", "desk")
STAGES = (
    DeliveryStage.FETCHING,
    DeliveryStage.PICKING_UP,
    DeliveryStage.CARRYING,
    DeliveryStage.SETTING_DOWN,
    DeliveryStage.DELIVERED,
)


def judged(record, *expected):
    record.final_state, record.reason = "delivered", "cup is on a table"
    return judge(record, {ERRAND, *expected})


def found_at(at, places=PLACES):
    record = MissionRecord()
    monitor = DeliveryMonitor(places, record.deliveries, lambda line: None)
    monitor.update(FIND, DeliveryStage.FETCHING, 1, "", Pose2())
    monitor.update(FIND, DeliveryStage.DELIVERED, 1, "cup is on a table", Pose2(), at)
    return record


def fetched_from(pickup, dropoff=Pose2()):
    record = MissionRecord()
    monitor = DeliveryMonitor(PLACES, record.deliveries, lambda line: None)
    for stage in STAGES:
        truth = pickup if stage.value <= DeliveryStage.CARRYING.value else dropoff
        monitor.update(FETCH, stage, 9, "", truth, (5.0, 2.0))
    return record, monitor


def test_an_object_is_found_where_it_truly_is():
    verdict = judged(found_at((5.1, 2.0)), OBJECTS)
    assert verdict.success and verdict.reason == "cup is on a table, at most 0.10 m off, no collision"


def test_a_find_at_the_wrong_place_is_a_failure():
    assert judged(found_at((4.0, 2.0))).reason == "cup truly is 1.00 m from where it was reported"


def test_a_find_without_ground_truth_proves_nothing():
    assert judged(found_at((4.0, 2.0), {})).reason == "it is not known where cup truly is"


def test_a_searched_object_is_picked_up_within_reach_of_where_it_truly_is():
    record, _ = fetched_from(Pose2(4.0, 2.0))
    assert judged(record).success
    assert record.deliveries[0].retries == 0, "drives to views are no retries"
    record, _ = fetched_from(Pose2(3.0, 2.0))
    assert "truly stood 0.50 m off" in judged(record).reason


def test_an_object_that_was_moved_is_where_it_was_set_down():
    record, monitor = fetched_from(Pose2(4.0, 2.0))
    monitor.update(FIND, DeliveryStage.DELIVERED, 0, "cup is at desk", Pose2(), (0.1, 0.0))
    assert record.deliveries[1].pickup_error == pytest.approx(0.1)


def test_the_marker_of_a_searched_object_is_carried_to_its_place():
    record, _ = fetched_from(Pose2(4.0, 2.0))
    assert record.objects_without_markers == ["cup"]
    markers = MarkerLog(PLACES, record)
    markers.add(MarkerUpdated(1.0, "cup", 0, (0.0, 0.0, 0.4), is_carried=True))
    markers.add(MarkerUpdated(2.0, "cup", 0, (0.1, 0.0, 0.1)))
    assert record.objects_without_markers == []
