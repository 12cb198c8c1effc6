"""The recorder keeps a mission completely, and a bounded number of events of a long run."""

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry, Path
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from evaluation.ros import run_recorder
from evaluation.ros.run_recorder import MAX_COLLISIONS, MAX_EVENTS, MAX_PLANS, RunRecorder
from evaluation.samples import MAX_SAMPLES

RATE = 20


@pytest.fixture
def subscribed(monkeypatch):
    """The recorder, and what it does with each topic."""
    callbacks = {}
    monkeypatch.setattr(run_recorder, "subscribe", lambda topic, _, call: callbacks.update({topic: call}))
    recorder = RunRecorder({})
    recorder.start()
    return recorder, callbacks


def drive(callbacks, seconds):
    for number in range(seconds * RATE):
        message = Odometry()
        message.header.stamp = rospy.Time.from_sec(number / RATE)
        message.pose.pose.position.x = number / RATE / 3.0
        message.pose.pose.orientation.w = 1.0
        callbacks["base_pose_ground_truth"](message)


def serve(callbacks, deliveries):
    for number in range(deliveries):
        callbacks["pick_objects/state"](String(f"going to {number}"))
        goal = PoseStamped()
        goal.pose.position.x, goal.pose.orientation.w = number, 1.0
        callbacks["move_base/current_goal"](goal)
        for _ in range(3):
            callbacks["move_base/NavfnROS/plan"](Path(poses=[goal]))
        callbacks["contacts"](String(f"sofa {number}"))
        marker = Marker(ns="cup", action=Marker.ADD)
        marker.pose.position.x = number
        callbacks["visualization_marker"](marker)


def test_a_mission_is_recorded_completely(subscribed):
    recorder, callbacks = subscribed
    drive(callbacks, 600)
    serve(callbacks, 20)
    record = recorder.record()
    stamps = np.arange(0, 600 * RATE, RATE // 10) / RATE
    assert np.allclose(record.truth[:, 0], stamps, rtol=0.0, atol=1e-6)
    assert np.array_equal(record.truth[:, 1], stamps / 3.0)
    kept = (record.states, record.goals, record.plans, record.collisions, record.markings)
    assert [len(events) for events in kept] == [20] * 5
    assert [plan[0, 0] for plan in record.plans] == [goal.x for goal in record.goals]


def test_only_the_latest_events_of_a_long_run_are_kept(subscribed):
    recorder, callbacks = subscribed
    serve(callbacks, 2000)
    record = recorder.record()
    assert len(record.states) == len(record.goals) == len(record.markings) == MAX_EVENTS
    assert len(record.plans) == MAX_PLANS
    assert len(record.collisions) == MAX_COLLISIONS
    assert record.states[-1].name == "going to 1999"
    assert record.plans[-1][0, 0] == record.goals[-1].x == 1999.0


def test_a_long_trajectory_is_kept_whole_with_fewer_samples(subscribed):
    recorder, callbacks = subscribed
    drive(callbacks, 2 * 3600)
    truth = recorder.record().truth
    assert MAX_SAMPLES / 2 < len(truth) <= MAX_SAMPLES
    assert truth[0, 0] == 0.0 and truth[-1, 0] > 7198.0
