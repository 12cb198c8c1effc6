"""Tells a simulator in lock-step how far a node has come."""

import rospy
from std_msgs.msg import Header

TOPIC = "/simulation/progress"


class ProgressPublisher:
    """Reports the simulated time up to which this node has worked; silent without simulated time."""

    def __init__(self):
        self._publisher = None
        if rospy.get_param("/use_sim_time", False):
            self._publisher = rospy.Publisher(TOPIC, Header, queue_size=10, tcp_nodelay=True)

    def report(self, stamp: rospy.Time) -> None:
        if self._publisher is not None:
            self._publisher.publish(Header(stamp=stamp, frame_id=rospy.get_name().lstrip("/")))
