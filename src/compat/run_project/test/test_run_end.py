"""A run is over when nothing more will come of it."""

import pytest

from evaluation.event_stream import EventStream
from evaluation.events import DELETE_ALL, SHOW, MarkerUpdated
from run_project.judging.run_end import (
    AFTER_GOALS,
    BETWEEN_GOALS,
    DELIVERED,
    ENOUGH_WALL_SECONDS,
    Quiet,
    is_over,
)
from run_project.judging.run_record import ProjectGoal, ProjectRunRecord

LONG = Quiet(1e6, 1e6)
RUNNING = {
    "script_is_over": False,
    "has_processes": True,
    "has_nodes": True,
    "has_goal_clients": True,
    "is_one_sleeping": False,
}


def record_of(*statuses):
    record = ProjectRunRecord(lambda _: None)
    record.goals = {
        str(number): ProjectGoal(status=status, place=(float(number), 0.0))
        for number, status in enumerate(statuses)
    }
    return record


def is_over_with(record, quiet, **states):
    return is_over(record, quiet, **{**RUNNING, **states})


def test_a_run_is_not_over_while_a_goal_is_active():
    assert not is_over_with(record_of("succeeded", "active"), LONG)


def test_it_is_over_when_all_processes_have_ended():
    assert is_over_with(record_of("active"), Quiet(0.0, 0.0), script_is_over=True, has_processes=False)
    assert not is_over_with(record_of("active"), Quiet(0.0, 0.0), has_processes=False)


@pytest.mark.parametrize(("has_clients", "limit"), [(True, BETWEEN_GOALS), (False, AFTER_GOALS)])
def test_simulated_time_decides_where_all_nodes_are_waited_for(has_clients, limit):
    record = record_of("succeeded", "aborted")
    states = {"has_goal_clients": has_clients}
    quiet = Quiet(ENOUGH_WALL_SECONDS + 0.1, limit.simulated + 0.1)
    assert is_over_with(record, quiet, **states)
    assert not is_over_with(record, quiet._replace(simulated=limit.simulated - 0.1), **states)
    assert not is_over_with(record, quiet._replace(wall=ENOUGH_WALL_SECONDS - 0.1), **states)


def test_a_node_that_sleeps_by_wall_time_is_waited_for():
    record = record_of("succeeded", "succeeded")
    states = {"has_goal_clients": False, "is_one_sleeping": True}
    assert not is_over_with(record, Quiet(AFTER_GOALS.wall - 0.1, 1e6), **states)
    assert is_over_with(record, Quiet(AFTER_GOALS.wall + 0.1, 1e6), **states)


def test_an_object_that_is_picked_up_is_waited_for():
    record = record_of("succeeded", "succeeded")
    record.markers = ["shown", "hidden"]
    quiet = Quiet(ENOUGH_WALL_SECONDS + 0.1, AFTER_GOALS.simulated + 0.1)
    assert not is_over_with(record, quiet, has_goal_clients=False)


@pytest.mark.parametrize(
    ("last", "states", "is_enough"),
    [
        ("succeeded", {}, True),
        ("aborted", {}, False),
        ("succeeded", {"has_goal_clients": True}, False),
        ("succeeded", {"is_one_sleeping": True}, False),
    ],
)
def test_little_time_is_enough_when_the_object_is_delivered_and_no_node_can_send_a_goal(
    last, states, is_enough
):
    record = record_of("succeeded", last)
    events = EventStream()
    record.attach(events)
    quiet = Quiet(DELIVERED.wall + 0.1, DELIVERED.simulated + 0.1)
    for action, place in ((SHOW, (1.0, 0.0)), (DELETE_ALL, (1.0, 0.0)), (SHOW, (2.0, 0.0))):
        assert not is_over_with(record, quiet, has_goal_clients=False)
        events.publish(
            MarkerUpdated(stamp=0.0, name="marker", number=0, position=(*place, 0.0), action=action)
        )
    assert is_over_with(record, quiet, **{"has_goal_clients": False, **states}) == is_enough


def test_a_first_goal_may_take_long():
    assert not is_over_with(record_of(), Quiet(80.0, 1e6))
    assert is_over_with(record_of(), LONG)


def test_a_script_that_leaves_no_node_is_over_soon_if_it_did_something():
    states = {"script_is_over": True, "has_nodes": False}
    assert is_over_with(record_of("succeeded"), Quiet(3.1, 0.0), **states)
    assert not is_over_with(record_of(), Quiet(3.1, 0.0), **states)
