import pytest
import rospy
from geometry_msgs.msg import Point, Pose, PoseStamped
from home_service_msgs.msg import DeliverActionGoal, DeliverGoal, Delivery, DeliveryState, MissionState
from nav_msgs.msg import Odometry, Path
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from evaluation.ros.referee import Referee
from evaluation.verdict import ERRAND, OBJECTS
from pick_objects import DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace

PLACES = {name: NamedPlace(name, Pose2(x, 0.0)) for name, x in (("hall", 2.0), ("door", 5.0))}


@pytest.fixture
def referee():
    return Referee(PLACES, log=lambda line: None)


def truth(stamp, x):
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.pose.pose.position.x, message.pose.pose.orientation.w = x, 1.0
    return message


def arrival(stamp):
    delivery = Delivery("post", "letter", "hall", "door")
    message = MissionState(state="picking up", deliveries=[DeliveryState(delivery, 2, 1, "")])
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


def test_an_arrival_is_judged_by_the_truth_at_its_stamp_even_if_that_arrives_later(referee):
    referee._on_truth(truth(1.0, 1.6))
    referee._on_mission(arrival(2.0))
    assert referee.mission_record.deliveries == []
    referee._on_truth(truth(2.0, 1.95))
    referee._on_truth(truth(2.1, 2.4))
    (record,) = referee.mission_record.deliveries
    assert record.pickup_error == pytest.approx(0.05)
    assert referee.mission_record.final_state == "picking up"


def test_an_arrival_is_judged_by_where_the_robot_stood_not_by_where_it_is(referee):
    for stamp, x in ((1.0, 2.01), (2.0, 3.0)):
        referee._on_truth(truth(stamp, x))
    referee._on_mission(arrival(1.0))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.01)


def test_the_marker_of_an_object_may_be_deleted_and_shown_again(referee):
    referee._on_mission(arrival(0.0))
    for action, is_locked, x in (
        (Marker.ADD, False, 2.0),
        (Marker.ADD, True, 0.0),
        (Marker.DELETE, False, 0.0),
    ):
        message = Marker(ns="letter", action=action, frame_locked=is_locked)
        message.pose.position.x, message.pose.orientation.w = x, 1.0
        referee._on_marker(message)
    assert referee.mission_record.markers == ["letter at hall", "letter carried"]


def test_missing_markers_are_not_waited_for_without_end(referee, monkeypatch):
    wall = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: wall[0])
    delivered = arrival(0.0)
    delivered.state, delivered.deliveries[0].state = "delivered", DeliveryStage.DELIVERED.value
    referee._on_truth(truth(1.0, 2.0))
    referee._on_mission(delivered)
    assert not referee.has_seen({ERRAND, OBJECTS})
    referee._on_truth(truth(50.0, 2.0))
    assert not referee.has_seen({ERRAND, OBJECTS})  # it may be this process that is late
    wall[0] = 150.0
    assert referee.has_seen({ERRAND, OBJECTS})
    assert referee.verdict({OBJECTS}).reason == "the markers of letter did not go with the objects"


MISSION = """
places: {attic: {x: 7.0, y: 0.0}, cellar: {x: 9.0, y: 0.0}}
objects: {lamp: {}}
deliveries: [{name: post, object: lamp, from: attic, to: cellar}]
"""


def moment(stamp, stage):
    delivery = Delivery("post", "lamp", "attic", "cellar")
    message = MissionState(state="on the way", deliveries=[DeliveryState(delivery, stage, 1, "")])
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


def marker_of_lamp(x):
    message = Marker(ns="lamp", action=Marker.ADD)
    message.pose.position.x, message.pose.orientation.w = x, 1.0
    return message


def test_places_defined_by_a_sent_mission_are_used(referee):
    referee._on_goal(DeliverActionGoal(goal=DeliverGoal(mission=MISSION)))
    referee._on_truth(truth(1.0, 6.9))
    referee._on_mission(moment(1.0, DeliveryState.PICKING_UP))
    referee._on_marker(marker_of_lamp(7.1))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.1)
    assert referee.mission_record.markers == ["lamp at attic"]


def test_a_marker_far_from_unknown_places_is_assigned_to_the_nearest_known_one(referee):
    referee._on_truth(truth(1.0, 6.9))
    referee._on_mission(moment(1.0, DeliveryState.PICKING_UP))
    referee._on_marker(marker_of_lamp(4.9))
    assert referee.mission_record.markers == ["lamp at door"]


def test_an_invalid_mission_changes_nothing(referee):
    referee._on_goal(DeliverActionGoal(goal=DeliverGoal(mission="places: 3")))
    assert referee.mission_record.deliveries == []


def test_a_delivery_that_is_sent_again_by_the_same_name_is_judged_again(referee):
    referee._on_goal(DeliverActionGoal(goal=DeliverGoal(mission=MISSION)))
    stages = (
        DeliveryState.PICKING_UP,
        DeliveryState.DELIVERED,
        DeliveryState.FETCHING,
        DeliveryState.PICKING_UP,
    )
    for stamp, stage in enumerate(stages, 1):
        referee._on_truth(truth(float(stamp), 7.0 + stamp / 100))
        referee._on_mission(moment(float(stamp), stage))
    first, second = referee.mission_record.deliveries
    assert first.state == "delivered"
    assert second.pickup_error == pytest.approx(0.04)


def test_a_marker_that_arrives_before_its_mission_is_assigned_when_the_mission_is_known(referee):
    referee._on_marker(marker_of_lamp(4.9))
    referee._on_goal(DeliverActionGoal(goal=DeliverGoal(mission=MISSION)))
    referee._on_mission(moment(1.0, DeliveryState.FETCHING))
    assert referee.mission_record.markers == []
    referee._on_truth(truth(1.0, 6.9))
    assert referee.mission_record.markers == ["lamp at attic"]


def test_a_pickup_is_judged_by_the_truth_at_its_moment(referee):
    """A robot that is driven away while it picks up, and reports that it has picked up."""
    for stamp, x in ((1.0, 2.01), (2.0, 2.9), (3.0, 4.0)):
        referee._on_truth(truth(stamp, x))
    referee._on_mission(arrival(1.0))
    picked_up = arrival(2.0)
    picked_up.deliveries[0].state = DeliveryState.CARRYING
    referee._on_mission(picked_up)
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.9)


def test_after_a_reset_of_time_the_truth_of_the_time_before_does_not_count(referee):
    for stamp in range(1, 10):
        referee._on_truth(truth(float(stamp), 2.0))
    referee._on_truth(truth(0.1, 0.0))
    referee._on_truth(truth(2.9, 0.0))
    picked_up = arrival(2.0)
    picked_up.deliveries[0].state = DeliveryState.CARRYING
    referee._on_mission(picked_up)
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(2.0)


def test_states_published_before_a_reset_of_time_do_not_wait_for_that_time_again(referee):
    referee._on_truth(truth(9.0, 2.1))
    referee._on_mission(arrival(9.1))
    referee._on_truth(truth(0.1, 0.0))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.1)


@pytest.mark.parametrize("state", ["", "delivered", "failed", "cancelled"])
def test_a_robot_without_a_mission_waits_for_one(state):
    serving = Referee(PLACES, log=lambda line: None, idle_text="waiting for a mission")
    serving._on_state(String(state))
    assert serving.status().startswith("waiting for a mission: ")
    serving._on_state(String("picking up"))
    assert serving.status().startswith("picking up: ")


def plan(*points_x):
    poses = [PoseStamped(pose=Pose(position=Point(x, 0.0, 0.0))) for x in points_x]
    return Path(poses=poses)


def test_the_distance_to_go_counts_down_along_the_plan(referee):
    referee._on_truth(truth(1.0, 0.0))
    assert "to go" not in referee.status()
    referee._on_plan(plan(0.0, 2.0, 5.0))
    for stamp, x, to_go in ((2.0, 1.0, "4.0"), (3.0, 4.5, "0.5"), (4.0, 5.2, "0.0")):
        referee._on_truth(truth(stamp, x))
        assert f"running: {to_go} m to go, " in referee.status()
    referee._on_plan(plan(5.2, 2.2))
    assert "3.0 m to go, " in referee.status()
    referee._on_result(None)
    assert "to go" not in referee.status()
