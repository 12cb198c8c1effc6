from types import SimpleNamespace

import rospy

from planar_ros.calls.actions import MOST_ENDED, server_is_ready, without_most_ended


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
