"""What the simulation says of itself when asked: a busy test hears its topics late."""

import rospy
from gazebo_msgs.srv import GetWorldProperties
from waiting import wait_until

ANSWER_SECONDS = 20.0


def wait_for_truth(heard, seconds):
    """Until the truth of now has been heard; ``heard()``: up to which stamp it has, simulated seconds."""
    name = "/gazebo/get_world_properties"
    rospy.wait_for_service(name, ANSWER_SECONDS)
    now = rospy.ServiceProxy(name, GetWorldProperties)().sim_time
    wait_until("the truth of now", lambda: heard() >= now, seconds)
