from home_service.judging.delivery_watch import DeliveryWatch
from pick_objects import Delivery, Stage
from planar import Pose2
from planar.maps.places import NamedPlace

KITCHEN = NamedPlace("kitchen", Pose2(0.0, 0.0))
DESK = NamedPlace("desk", Pose2(5.0, 0.0), approaches=(Pose2(5.0, 1.0),))
TEA = Delivery("tea", "cup", "kitchen", "desk")


def watched(*steps):
    records, said = [], []
    watch = DeliveryWatch({"kitchen": KITCHEN, "desk": DESK}, records, said.append)
    for stage, truth in steps:
        watch.see(TEA, stage, 3, "why", truth)
    return records[0], said


def test_errors_are_measured_on_arrival_to_the_nearest_pose_of_the_place():
    record, said = watched(
        (Stage.FETCHING, Pose2(-1.0, 0.0)),
        (Stage.PICKING_UP, Pose2(0.1, 0.0)),
        (Stage.CARRYING, Pose2(1.0, 0.0)),
        (Stage.DELIVERED, Pose2(5.0, 0.8)),
    )
    assert (round(record.pickup_error, 3), round(record.dropoff_error, 3)) == (0.1, 0.2)
    assert record.complaint is None
    assert said == ["at kitchen: truly 0.100 m from it", "at desk: truly 0.200 m from it"]


def test_a_delivery_that_fails_on_the_way_never_arrived():
    record, _ = watched((Stage.FETCHING, Pose2()), (Stage.FAILED, Pose2()))
    assert record.pickup_error is record.dropoff_error is None
    assert record.complaint == "tea is failed: why"
