"""Goals of a project are logged with their places, whichever message of a goal comes first or not at all."""

import itertools

import pytest

from evaluation.event_stream import EventStream
from evaluation.events import SUCCEEDED, GoalAccepted, GoalEnded, GoalRequested, GoalStatusUpdated
from planar import Pose2
from run_project.judging.run_record import ProjectRunRecord

ACTIVE = 1  # of actionlib
FIRST, SECOND = Pose2(0.0, 3.0), Pose2(7.0, 4.0)
LOGGED = [
    "goal 1 at (0.00, 3.00) active",
    "goal 1 at (0.00, 3.00) succeeded",
    "goal 2 at (7.00, 4.00) active",
    "goal 2 at (7.00, 4.00) succeeded",
]


def messages(name, pose):
    return (
        GoalRequested(0.0, name, "map", pose),
        GoalAccepted(0.0, pose),
        GoalStatusUpdated(0.0, name, ACTIVE, ""),
    )


def logged(*events):
    lines, stream = [], EventStream()
    ProjectRunRecord(lines.append).attach(stream)
    for event in events:
        stream.publish(event)
    return lines


@pytest.mark.parametrize("order", itertools.permutations(range(3)))
@pytest.mark.parametrize("is_goal_received", [True, False])
def test_goals_are_logged_with_their_places(order, is_goal_received):
    events = []
    for name, pose in (("a", FIRST), ("b", SECOND)):
        sent = messages(name, pose)
        events += [sent[index] for index in order if index or is_goal_received]
        events.append(GoalEnded(1.0, name, SUCCEEDED, ""))
    assert logged(*events) == LOGGED


def test_a_goal_that_follows_a_missed_one_keeps_its_own_place():
    missed = messages("a", FIRST)[1:]
    assert logged(*missed, GoalEnded(1.0, "a", SUCCEEDED, ""), *messages("b", SECOND))[2:] == LOGGED[2:3]
