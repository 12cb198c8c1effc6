"""The topics of a run as events: one subscription a topic, opened when all consumers are there."""

from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import TransformStamped
from home_service_msgs.msg import Delivery, DeliveryState, MissionState
from move_base_msgs.msg import MoveBaseActionResult
from nav_msgs.msg import Odometry, Path
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.consumers.trace_recorder import TraceRecorder
from evaluation.event_stream import EventStream, Latest
from evaluation.events import (
    SUCCEEDED,
    BodiesTouched,
    CorrectionUpdated,
    GoalEnded,
    LineLogged,
    MarkerUpdated,
    MissionUpdated,
    OdometryUpdated,
    OtherRobotUpdated,
    PlanUpdated,
    StateUpdated,
    TruthUpdated,
)
from evaluation.ros import run_topics
from evaluation.ros.run_topics import RunTopics, observe
from pick_objects import DeliveryStage
from planar import Pose2


@pytest.fixture
def ros(monkeypatch):
    """rospy whose publishers send their latched messages at once, to the first subscription only."""
    state = SimpleNamespace(latched={}, opened=[], receive={}, errors=[])

    def open_subscription(topic, kind, callback, **_):
        state.opened.append(topic)
        state.receive[topic] = lambda message: callback(with_header(message))
        for each in state.latched.pop(topic, ()):
            state.receive[topic](each)

    monkeypatch.setattr(run_topics.rospy, "Subscriber", open_subscription)
    monkeypatch.setattr(run_topics.rospy, "resolve_name", lambda name: f"/{name.lstrip('/')}")
    monkeypatch.setattr(run_topics.rospy, "logerr", lambda *text: state.errors.append(text))
    return state


def with_header(message):
    message._connection_header = {"callerid": "/a_node"}
    return message


def latest(kind):
    """A consumer of an event type whose topics are open."""
    consumer = Latest(kind)
    observe(consumer)
    return consumer


def truth(stamp, x=1.0):
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.pose.pose.position.x, message.pose.pose.orientation.w = x, 1.0
    return message


def test_each_topic_of_a_run_is_subscribed_to_once(ros):
    observe(TraceRecorder(), Referee({}, print, logs_goals=True), RunRecorder({}))
    assert len(set(ros.opened)) == len(ros.opened)
    assert {"/base_pose_ground_truth", "/follower/base_pose_ground_truth", "/tf", "/map"} <= set(ros.opened)


def test_only_topics_whose_events_are_consumed_are_subscribed_to(ros):
    latest(StateUpdated)
    assert ros.opened == ["/pick_objects/state"]


def test_all_consumers_receive_the_first_messages(ros):
    ros.latched["/pick_objects/state"] = [String("going to the hall"), String("picking up")]
    recorder, referee = RunRecorder({}), Referee({}, print)
    observe(recorder, referee)
    assert [state.name for state in recorder.record().states] == ["going to the hall", "picking up"]
    assert referee.state == "picking up"


def test_an_error_of_one_consumer_is_logged_and_keeps_messages_from_no_other(ros):
    broken = SimpleNamespace(attach=lambda events: events.subscribe(StateUpdated, lambda event: 1 / 0))
    state = Latest(StateUpdated)
    observe(broken, state)
    ros.receive["/pick_objects/state"](String("delivered"))
    assert state.event.text == "delivered"
    assert "ZeroDivisionError" in str(ros.errors)


def test_messages_without_a_stamp_bear_the_time_of_the_latest_truth(ros):
    state, truths = Latest(StateUpdated), Latest(TruthUpdated)
    observe(state, truths, Latest(OtherRobotUpdated))
    ros.receive["/base_pose_ground_truth"](truth(2.5))
    ros.receive["/follower/base_pose_ground_truth"](truth(9.0))
    ros.receive["/pick_objects/state"](String("delivered"))
    assert state.event == StateUpdated(2.5, "delivered")
    assert truths.event.pose == Pose2(1.0)
    assert truths.event.publication == (2500000000, "/base_pose_ground_truth", "/a_node", (0.0, 1.0))


def test_the_time_may_be_kept_by_another_event(ros):
    events, touched = EventStream(), Latest(BodiesTouched)
    touched.attach(events)
    state = Latest(StateUpdated)
    state.attach(events)
    topics = RunTopics(events, timekeeper=StateUpdated)
    topics.open()
    ros.receive["/contacts"](String("sofa\nwall"))
    assert touched.event == BodiesTouched(0.0, ("sofa", "wall"))


def test_messages_of_another_robot_are_events_of_that_robot(ros):
    other = latest(OtherRobotUpdated)
    ros.receive["/follower/contacts"](String("sofa"))
    assert other.event == OtherRobotUpdated(0.0, "follower", BodiesTouched(0.0, ("sofa",)))


def test_odometry_and_its_correction_are_read_from_the_transforms(ros):
    odometry, correction = Latest(OdometryUpdated), Latest(CorrectionUpdated)
    observe(odometry, correction)
    message = TFMessage()
    for parent, child, x in (
        ("map", "/odom", 2.0),
        ("/odom", "base_footprint", 3.0),
        ("base_link", "laser", 4.0),
    ):
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, rospy.Time(5)
        transform.transform.translation.x, transform.transform.rotation.w = x, 1.0
        message.transforms.append(transform)
    ros.receive["/tf"](message)
    assert odometry.event == OdometryUpdated(5.0, Pose2(3.0))
    assert correction.event == CorrectionUpdated(5.0, Pose2(2.0))


def test_a_mission_is_read_with_its_deliveries(ros):
    mission = latest(MissionUpdated)
    delivery = DeliveryState(Delivery("post", "letter", "hall", "door"), DeliveryState.CARRYING, 2, "")
    message = MissionState(state="on the way", place="door", attempt=2, deliveries=[delivery])
    message.header.stamp = rospy.Time(3)
    ros.receive["/pick_objects/mission_state"](message)
    (progress,) = mission.event.deliveries
    assert (progress.stage, progress.attempts) == (DeliveryStage.CARRYING, 2)
    assert progress.delivery.destination == "door"
    assert (mission.event.stamp, mission.event.place, mission.event.attempt) == (3.0, "door", 2)


def test_a_marker_is_read_with_what_can_be_seen_of_it(ros):
    marker = latest(MarkerUpdated)
    message = Marker(ns="cup", id=7, action=Marker.ADD, frame_locked=True)
    message.pose.position.x = 2.0
    for scale, alpha, is_visible in ((0.0, 1.0, False), (0.1, 0.0, False), (0.1, 1.0, True)):
        message.scale.x, message.color.a = scale, alpha
        ros.receive["/visualization_marker"](message)
        assert marker.event == MarkerUpdated(0.0, "cup", 7, (2.0, 0.0, 0.0), 0, True, is_visible)


def test_the_end_of_a_goal_and_a_plan_are_read(ros):
    end, plan = Latest(GoalEnded), Latest(PlanUpdated)
    observe(end, plan)
    message = MoveBaseActionResult()
    message.status.status, message.status.text, message.status.goal_id.id = 3, "Goal reached.", "a"
    ros.receive["/move_base/result"](message)
    ros.receive["/move_base/NavfnROS/plan"](Path())
    assert (end.event.identity, end.event.status, end.event.text) == ("a", SUCCEEDED, "Goal reached.")
    assert plan.event.points_xy.shape == (0, 2)


def test_lines_about_connections_are_left_out(ros):
    line = latest(LineLogged)
    ros.receive["/rosout_agg"](Log(name="/amcl", msg="inbound", level=Log.WARN, file="tcpros_base.py"))
    assert line.event is None
    ros.receive["/rosout_agg"](Log(name="/amcl", msg="lost", level=Log.ERROR))
    assert line.event == LineLogged(0.0, "amcl", "lost", is_warning=True)


def test_a_complaint_about_a_shader_of_rviz_is_no_warning(ros):
    line = latest(LineLogged)
    text = "rviz/glsl120/indexed_8bit_image.vert\n GLSL link result :\nactive samplers with a different type"
    ros.receive["/rosout_agg"](Log(name="/rviz", msg=text, level=Log.ERROR))
    assert line.event == LineLogged(0.0, "rviz", text, is_warning=False)
