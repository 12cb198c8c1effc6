"""What the simulation says of itself when asked: a busy test hears its topics late."""

import rospy
from gazebo_msgs.srv import GetWorldProperties

ANSWER_SECONDS = 20.0


def time_now():
    """Simulated seconds."""
    name = "/gazebo/get_world_properties"
    rospy.wait_for_service(name, ANSWER_SECONDS)
    return rospy.ServiceProxy(name, GetWorldProperties)().sim_time
