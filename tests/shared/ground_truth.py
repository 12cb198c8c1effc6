"""Waiting for ground truth: a busy test receives its topics late."""

import rospy
from gazebo_msgs.srv import GetWorldProperties
from waiting import wait_until

ANSWER_SECONDS = 20.0


def wait_for_ground_truth(stamp, seconds):
    """Wait until ``stamp()``, the newest stamp received [s], reaches the current simulated time."""
    name = "/gazebo/get_world_properties"
    rospy.wait_for_service(name, ANSWER_SECONDS)
    now = rospy.ServiceProxy(name, GetWorldProperties)().sim_time
    wait_until("the current ground truth", lambda: stamp() >= now, seconds)
