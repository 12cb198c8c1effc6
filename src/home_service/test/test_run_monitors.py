"""Monitors of runs with a follower and of explorations, fed with events."""

from types import SimpleNamespace

import pytest

from evaluation.event_stream import EventStream
from evaluation.events import (
    BodiesTouched,
    ExplorationEnded,
    ExplorationUpdated,
    OtherRobotUpdated,
    TruthUpdated,
)
from home_service.exploration_monitor import ExplorationMonitor
from home_service.follow_monitor import FollowMonitor
from planar import Pose2


@pytest.fixture
def events():
    return EventStream()


@pytest.fixture
def following(events):
    monitor = FollowMonitor("follower")
    monitor.attach(events)
    return monitor


def leader(events, stamp, x):
    events.publish(TruthUpdated(stamp, Pose2(x)))


def follower(events, stamp, x, robot="follower"):
    events.publish(OtherRobotUpdated(stamp, robot, TruthUpdated(stamp, Pose2(x))))


def test_distances_count_at_common_stamps_from_the_departure_of_the_leader_on(events, following):
    leader(events, 1.0, 0.0)
    follower(events, 1.0, -9.0)
    leader(events, 2.0, 1.0)
    follower(events, 2.0, 0.0)
    follower(events, 3.0, 0.0)
    leader(events, 3.0, 4.0)
    leader(events, 4.0, 9.0)
    follower(events, 4.0, 8.0, robot="another")
    fields = following.result_fields()
    assert (fields["follower_share_near"], fields["follower_farthest"]) == (0.5, 4.0)
    assert following.failure == "the follower was within 1.5 m for 50 % of the time only"


def test_contacts_of_the_follower_are_a_failure_and_those_of_the_leader_are_not(events, following):
    leader(events, 1.0, 0.0)
    leader(events, 2.0, 1.0)
    follower(events, 2.0, 0.0)
    events.publish(BodiesTouched(2.0, ("wall",)))
    assert following.failure is None
    events.publish(OtherRobotUpdated(2.0, "follower", BodiesTouched(2.0, ("sofa",))))
    assert following.failure == "the follower collided with sofa"


def test_the_progress_of_an_exploration_is_the_state_of_the_referee_and_its_first_end_counts(events):
    referee = SimpleNamespace(state="", simulated_seconds=12.0)
    exploration = ExplorationMonitor(referee)
    exploration.attach(events)
    events.publish(ExplorationUpdated(1.0, "exploring", 12.4, 3))
    assert referee.state == "exploring, 12 m2 known, 3 frontiers"
    assert exploration.end is None
    events.publish(ExplorationEnded(2.0, 3, "explored"))
    events.publish(ExplorationEnded(3.0, 4, "aborted"))
    assert exploration.end.text == "explored"
