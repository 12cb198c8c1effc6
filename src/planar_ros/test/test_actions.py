from types import SimpleNamespace

import rospy

from planar_ros.calls.actions import MOST_ENDED, without_most_ended


def test_goals_that_have_ended_are_forgotten_but_for_the_last():
    times = map(rospy.Time, range(1, 3 * MOST_ENDED))
    ended = [SimpleNamespace(handle_destruction_time=time) for time in times]
    pursued = SimpleNamespace(handle_destruction_time=rospy.Time())
    assert without_most_ended([pursued, *ended]) == [pursued, *ended[-MOST_ENDED:]]
    assert without_most_ended([*ended[:2], pursued]) == [*ended[:2], pursued]
    assert without_most_ended([]) == []
