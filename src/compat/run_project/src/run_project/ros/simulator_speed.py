"""Speed of the simulator while it runs, or before it starts."""

import threading

import rosgraph
import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure

SIMULATOR, SPEED = "/gazebo", "speed"


def set_simulator_speed(speed: float) -> None:
    """Set the speed of the simulator, also of one that starts later, without waiting for it."""
    rospy.set_param(f"{SIMULATOR}/{SPEED}", speed)
    threading.Thread(target=_reconfigure, args=(speed,), daemon=True).start()


def _reconfigure(speed: float) -> None:
    service = f"{SIMULATOR}/set_parameters"
    try:
        rosgraph.Master("/run_project").lookupService(service)
        rospy.ServiceProxy(service, Reconfigure)(Config(doubles=[DoubleParameter(SPEED, speed)]))
    except (rosgraph.MasterException, rospy.ServiceException, rospy.ROSException, OSError) as error:
        rospy.logdebug("the simulator's speed is set when it starts: %s", error)
