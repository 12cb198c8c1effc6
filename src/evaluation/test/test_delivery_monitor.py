from evaluation.delivery_monitor import DeliveryMonitor
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


def test_errors_are_measured_to_the_nearest_pose_of_the_place():
    record, logged = monitored(
        (DeliveryStage.FETCHING, Pose2(-1.0, 0.0)),
        (DeliveryStage.PICKING_UP, Pose2(0.1, 0.0)),
        (DeliveryStage.CARRYING, Pose2(0.1, 0.0)),
        (DeliveryStage.DELIVERED, Pose2(5.0, 0.8)),
    )
    assert (round(record.pickup_error, 3), round(record.dropoff_error, 3)) == (0.1, 0.2)
    assert record.failure is None
    assert logged == ["at kitchen: truly 0.100 m from it", "at desk: truly 0.200 m from it"]


def test_a_delivery_that_fails_on_the_way_never_arrived():
    record, _ = monitored((DeliveryStage.FETCHING, Pose2()), (DeliveryStage.FAILED, Pose2()))
    assert record.pickup_error is record.dropoff_error is None
    assert record.failure == "tea is failed: why"


def test_errors_are_those_at_the_moment_of_picking_up_and_setting_down():
    record, logged = monitored(
        (DeliveryStage.PICKING_UP, Pose2(0.1, 0.0)),
        (DeliveryStage.CARRYING, Pose2(0.9, 0.0)),
        (DeliveryStage.CARRYING, Pose2(3.0, 0.0)),
        (DeliveryStage.SETTING_DOWN, Pose2(5.0, 0.9)),
        (DeliveryStage.DELIVERED, Pose2(5.0, 3.0)),
        (DeliveryStage.DELIVERED, Pose2(0.0, 0.0)),
    )
    assert (round(record.pickup_error, 3), round(record.dropoff_error, 3)) == (0.9, 2.0)
    assert record.failure == "at kitchen the robot truly stood 0.90 m off, more than 0.25 m"
    assert logged == [
        "at kitchen: truly 0.100 m from it",
        "picked up at kitchen: truly 0.900 m from it",
        "at desk: truly 0.100 m from it",
        "set down at desk: truly 2.000 m from it",
    ]


def test_a_robot_that_returns_to_its_place_is_judged_by_where_it_picks_up_in_the_end():
    record, _ = monitored(
        (DeliveryStage.PICKING_UP, Pose2(0.1, 0.0)),
        (DeliveryStage.FETCHING, Pose2(2.0, 0.0)),
        (DeliveryStage.PICKING_UP, Pose2(0.2, 0.0)),
        (DeliveryStage.CARRYING, Pose2(0.2, 0.0)),
    )
    assert round(record.pickup_error, 3) == 0.2


def test_a_delivery_that_is_only_reported_is_judged_by_where_the_robot_is():
    record, _ = monitored((DeliveryStage.WAITING, Pose2()), (DeliveryStage.DELIVERED, Pose2()))
    assert record.pickup_error == 0.0
    assert record.failure == "at desk the robot truly stood 5.00 m off, more than 0.25 m"


def test_retries_count_from_the_first_goal_that_had_to_be_sent_again():
    records = []
    monitor = DeliveryMonitor({}, records, str)
    history = [
        (DeliveryStage.WAITING, 0, 0),
        (DeliveryStage.FETCHING, 1, 0),
        (DeliveryStage.FETCHING, 2, 1),
        (DeliveryStage.PICKING_UP, 2, 1),
        (DeliveryStage.CARRYING, 3, 1),
        (DeliveryStage.CARRYING, 5, 3),
        (DeliveryStage.FAILED, 5, 3),
    ]
    for stage, attempts, retries in history:
        monitor.update(TEA, stage, attempts, "", None)
        assert records[0].retries == retries
    assert records[0].result_fields()["retries"] == 3
