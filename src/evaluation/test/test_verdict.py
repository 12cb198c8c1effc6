import pytest

from evaluation.verdict import DEMO, ERRAND, MARKERS, OBJECTS, DeliveryRecord, MissionRecord, judge

STORY = ["shown at pickup", "hidden", "shown at dropoff"]


def record(**changes):
    fields = {"state": "delivered", "pickup_error": 0.1, "dropoff_error": 0.2, **changes}
    return DeliveryRecord("errand", "parcel", "pickup", "dropoff", **fields)


def good_ledger():
    return MissionRecord([record()], [], list(STORY), "delivered")


def test_a_proven_delivery_is_a_success():
    verdict = judge(good_ledger(), {ERRAND, MARKERS})
    assert verdict.success
    assert "0.20 m" in verdict.reason


@pytest.mark.parametrize(
    "change, reason",
    [
        ({"final_state": "going to dropoff"}, "state 'going to dropoff'"),
        ({"deliveries": [record(dropoff_error=None)]}, "never reported its arrival at dropoff"),
        ({"deliveries": [record(pickup_error=0.3)]}, "at pickup the robot truly stood 0.30 m off"),
        ({"deliveries": []}, "nothing was delivered"),
        ({"deliveries": [record(state="failed", reason="blocked")]}, "errand is failed: blocked"),
        ({"final_state": "failed", "reason": "0 of 2 delivered"}, "0 of 2 delivered"),
        ({"collisions": ["sofa", "sofa"]}, "collided with sofa"),
        ({"markers": STORY[:1]}, "the marker was shown at pickup, not"),
        ({"failure": "roslaunch ended"}, "roslaunch ended"),
    ],
)
def test_missing_evidence_is_a_failure_with_a_reason(change, reason):
    mission_record = good_ledger()
    for name, value in change.items():
        setattr(mission_record, name, value)
    verdict = judge(mission_record, {ERRAND, MARKERS})
    assert not verdict.success
    assert reason in verdict.reason


def test_a_demonstration_needs_only_the_marker():
    assert judge(MissionRecord(markers=list(STORY)), {DEMO}).success


def test_a_run_is_complete_when_all_that_is_expected_was_seen():
    assert good_ledger().is_complete({ERRAND, MARKERS})
    assert not MissionRecord(final_state="delivered", markers=STORY[:2]).is_complete({ERRAND, MARKERS})
    assert MissionRecord(final_state="failed").is_complete({ERRAND, MARKERS})
    assert not MissionRecord().is_complete({ERRAND})


def test_the_markers_of_a_mission_go_with_their_objects():
    mission_record = MissionRecord(
        [record()], [], ["parcel at pickup", "cup at desk", "parcel carried"], "delivered"
    )
    assert not mission_record.is_complete({ERRAND, OBJECTS})
    assert "markers of parcel" in judge(mission_record, {ERRAND, OBJECTS}).reason
    mission_record.markers.append("parcel at dropoff")
    assert mission_record.is_complete({ERRAND, OBJECTS})
    assert judge(mission_record, {ERRAND, OBJECTS}).success


def test_a_cancelled_delivery_does_not_fail_the_others():
    mission_record = MissionRecord([record(), record(state="cancelled")], final_state="delivered")
    assert judge(mission_record, {ERRAND}).success
