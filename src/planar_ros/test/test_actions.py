from types import SimpleNamespace

import actionlib
import pytest
import rospy
from actionlib.action_client import GoalManager
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseActionResult, MoveBaseGoal

from planar_ros.calls import actions
from planar_ros.calls.actions import (
    MAX_ENDED_GOALS,
    ActionServer,
    goal_is_lost,
    goal_is_over,
    prune_ended,
    server_connection,
    server_is_ready,
)
from planar_ros.lockstep import LockstepClient
from rospy_transport.node import set_time, unregistered_node


def test_ended_goals_are_pruned_except_the_last_ones():
    times = map(rospy.Time, range(1, 3 * MAX_ENDED_GOALS))
    ended = [SimpleNamespace(handle_destruction_time=time) for time in times]
    active = SimpleNamespace(handle_destruction_time=rospy.Time())
    assert prune_ended([active, *ended]) == [active, *ended[-MAX_ENDED_GOALS:]]
    assert prune_ended([*ended[:2], active]) == [*ended[:2], active]
    assert prune_ended([]) == []


@pytest.fixture
def client(monkeypatch):
    """Factory of an action client whose topics are the lists of the nodes connected to them."""
    monkeypatch.setattr(actions, "is_connected", lambda topic, node: node in topic)
    monkeypatch.setattr(actions, "connected_publishers", set)

    def made(goal_subscribers, result_publisher="/server"):
        status = SimpleNamespace(_connection_header={"callerid": "/server"})
        inner = SimpleNamespace(
            last_status_msg=status,
            pub_goal=goal_subscribers,
            pub_cancel=["/server"],
            result_sub=[result_publisher],
        )
        return SimpleNamespace(action_client=inner)

    return made


def test_a_server_is_ready_only_when_it_has_subscribed_to_goals_itself(client):
    assert not server_is_ready(client(goal_subscribers=["/recorder"]))
    assert server_is_ready(client(goal_subscribers=["/recorder", "/server"]))


def test_a_server_is_not_ready_before_its_results_can_be_received(client):
    assert not server_is_ready(client(goal_subscribers=["/server"], result_publisher="unknown"))


@pytest.fixture
def sending():
    """Factory of a client whose goals go to a function; returns the client and its goal manager."""

    def made(send):
        manager = GoalManager(MoveBaseAction)
        manager.register_send_goal_fn(lambda goal: send(goal, manager))
        manager.register_cancel_fn(None)
        client = actionlib.SimpleActionClient.__new__(actionlib.SimpleActionClient)
        client.action_client = SimpleNamespace(send_goal=manager.init_goal, ns="a", last_status_msg=None)
        client.simple_state, client.gh = actionlib.SimpleGoalState.DONE, None
        return client, manager

    with unregistered_node():
        yield made


def test_a_goal_is_over_even_if_its_result_arrives_before_send_goal_returns(sending):
    def refuse(goal, manager):
        status = GoalStatus(goal_id=goal.goal_id, status=GoalStatus.ABORTED, text="no way")
        manager.update_results(MoveBaseActionResult(status=status))

    client, _ = sending(refuse)
    assert goal_is_over(client)
    client.send_goal(MoveBaseGoal())
    assert goal_is_over(client)
    assert client.get_goal_status_text() == "no way"


def test_a_goal_is_lost_when_its_server_restarts_before_acknowledging_it(sending):
    client, manager = sending(lambda goal, manager: None)

    def receive_status(connection_header, after, *goal_ids):
        message = GoalStatusArray(status_list=[GoalStatus(goal_id=goal_id) for goal_id in goal_ids])
        message.header.stamp = rospy.Time.now() + rospy.Duration.from_sec(after)
        message._connection_header = connection_header
        client.action_client.last_status_msg = message
        manager.update_statuses(message)

    before, restarted = {"callerid": "/server"}, {"callerid": "/server"}
    receive_status(before, 0.0)
    sent_to = server_connection(client)
    client.send_goal(MoveBaseGoal())
    for header, after, is_lost in ((before, 2.0, False), (restarted, 0.1, False), (restarted, 2.0, True)):
        receive_status(header, after)
        assert goal_is_lost(client, sent_to) is is_lost
    receive_status(restarted, 2.0, client.gh.comm_state_machine.action_goal.goal_id)
    assert not goal_is_lost(client, sent_to)


@pytest.fixture
def server(monkeypatch):
    """An action server without a master; ``on_time_jump`` simulates a jump back of time."""
    endpoint = SimpleNamespace(publish=lambda message: None, shutdown=lambda: None)
    for name in ("Publisher", "Subscriber", "Timer"):
        monkeypatch.setattr(rospy, name, lambda *_, **__: endpoint)
    monkeypatch.setattr(rospy, "get_param", lambda _, default=None: default)
    monkeypatch.setattr(rospy, "has_param", lambda _: False)
    monkeypatch.setattr(rospy, "search_param", lambda _: None)
    monkeypatch.setattr(rospy, "get_name", lambda: "/server")
    monkeypatch.setattr(rospy, "on_shutdown", lambda hook: None)
    hooks = []
    step = SimpleNamespace(
        is_synchronized=False, every=lambda *given: hooks.append(given), defer=lambda do: do()
    )
    monkeypatch.setattr(LockstepClient, "of_node", lambda: step)
    with unregistered_node():
        server = ActionServer("action", MoveBaseAction, auto_start=False)
        server.start()
        server.on_time_jump = hooks[0][2]
        yield server


def goal_at(seconds):
    set_time(rospy.Time(seconds))
    return MoveBaseActionGoal(goal_id=GoalID(rospy.Time(seconds), f"at {seconds}"))


@pytest.mark.parametrize("is_over", (True, False))
def test_after_time_has_jumped_back_goals_are_accepted_whatever_the_last_stamp(server, is_over):
    server.action_server.internal_goal_callback(goal_at(80))
    server.accept_new_goal()
    if is_over:
        server.set_succeeded()
    server.action_server.internal_cancel_callback(GoalID(stamp=rospy.Time(80), id="another"))
    goal = goal_at(1)
    server.on_time_jump()
    server.action_server.internal_goal_callback(goal)
    assert server.is_new_goal_available()


def test_a_cancel_stamped_far_ahead_does_not_cancel_later_goals(server):
    set_time(rospy.Time(10))
    server.action_server.internal_cancel_callback(GoalID(stamp=rospy.Time(2_000_000_000)))
    server.action_server.internal_goal_callback(goal_at(12))
    assert server.is_new_goal_available()
