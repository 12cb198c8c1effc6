from types import SimpleNamespace

import actionlib
import rospy
from actionlib.action_client import GoalManager
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionResult, MoveBaseGoal

from planar_ros.calls.actions import MOST_ENDED, goal_is_over, server_is_ready, without_most_ended


def test_goals_that_have_ended_are_forgotten_but_for_the_last():
    times = map(rospy.Time, range(1, 3 * MOST_ENDED))
    ended = [SimpleNamespace(handle_destruction_time=time) for time in times]
    pursued = SimpleNamespace(handle_destruction_time=rospy.Time())
    assert without_most_ended([pursued, *ended]) == [pursued, *ended[-MOST_ENDED:]]
    assert without_most_ended([*ended[:2], pursued]) == [*ended[:2], pursued]
    assert without_most_ended([]) == []


def client(goals_heard_by):
    def publisher(*listeners):
        impl = SimpleNamespace(has_connection=lambda name: name in listeners)
        return SimpleNamespace(impl=impl, get_num_connections=lambda: len(listeners))

    told = SimpleNamespace(_connection_header={"callerid": "/server"})
    inner = SimpleNamespace(
        last_status_msg=told,
        pub_goal=publisher(*goals_heard_by),
        pub_cancel=publisher("/server"),
        result_sub=publisher("/server"),
    )
    return SimpleNamespace(action_client=inner)


def test_a_server_is_ready_when_it_hears_goals_and_not_when_somebody_else_does():
    assert not server_is_ready(client(goals_heard_by=["/recorder"]))
    assert server_is_ready(client(goals_heard_by=["/recorder", "/server"]))


def test_a_goal_is_over_even_if_its_result_overtakes_the_return_of_its_sending(monkeypatch):
    manager = GoalManager(MoveBaseAction)

    def refuse(goal):
        status = GoalStatus(goal_id=goal.goal_id, status=GoalStatus.ABORTED, text="no way")
        manager.update_results(MoveBaseActionResult(status=status))

    manager.register_send_goal_fn(refuse)
    manager.register_cancel_fn(None)
    monkeypatch.setattr(rospy.rostime, "_rostime_initialized", True)
    client = actionlib.SimpleActionClient.__new__(actionlib.SimpleActionClient)
    client.action_client = SimpleNamespace(send_goal=manager.init_goal, ns="move_base")
    client.simple_state, client.gh = actionlib.SimpleGoalState.DONE, None
    assert goal_is_over(client)
    client.send_goal(MoveBaseGoal())
    assert goal_is_over(client)
    assert client.get_goal_status_text() == "no way"
