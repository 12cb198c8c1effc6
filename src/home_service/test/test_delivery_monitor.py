from home_service.judging.delivery_monitor import DeliveryMonitor
from pick_objects import Delivery, DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace

KITCHEN = NamedPlace("kitchen", Pose2(0.0, 0.0))
DESK = NamedPlace("desk", Pose2(5.0, 0.0), approaches=(Pose2(5.0, 1.0),))
TEA = Delivery("tea", "cup", "kitchen", "desk")


def monitored(*steps):
    records, logged = [], []
    monitor = DeliveryMonitor({"kitchen": KITCHEN, "desk": DESK}, records, logged.append)
    for stage, truth in steps:
        monitor.update(TEA, stage, 3, "why", truth)
    return records[0], logged


def test_errors_are_measured_on_arrival_to_the_nearest_pose_of_the_place():
    record, logged = monitored(
        (DeliveryStage.FETCHING, Pose2(-1.0, 0.0)),
        (DeliveryStage.PICKING_UP, Pose2(0.1, 0.0)),
        (DeliveryStage.CARRYING, Pose2(1.0, 0.0)),
        (DeliveryStage.DELIVERED, Pose2(5.0, 0.8)),
    )
    assert (round(record.pickup_error, 3), round(record.dropoff_error, 3)) == (0.1, 0.2)
    assert record.failure is None
    assert logged == ["at kitchen: truly 0.100 m from it", "at desk: truly 0.200 m from it"]


def test_a_delivery_that_fails_on_the_way_never_arrived():
    record, _ = monitored((DeliveryStage.FETCHING, Pose2()), (DeliveryStage.FAILED, Pose2()))
    assert record.pickup_error is record.dropoff_error is None
    assert record.failure == "tea is failed: why"
