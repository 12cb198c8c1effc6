"""Speed of the simulator while it runs, or before it starts."""

import threading

import rosgraph
import rospy
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties

SIMULATOR = "/gazebo"


def set_simulator_speed(speed: float) -> None:
    """Set the speed of the simulator, also of one that starts later, without waiting for it.

    Args:
        speed: Multiple of real time; 0 for no limit.
    """
    rospy.set_param(f"{SIMULATOR}/speed", speed)
    threading.Thread(target=_set_physics, args=(speed,), daemon=True).start()


def _set_physics(speed: float) -> None:
    service = f"{SIMULATOR}/set_physics_properties"
    try:
        rosgraph.Master("/run_project").lookupService(service)
        now = rospy.ServiceProxy(f"{SIMULATOR}/get_physics_properties", GetPhysicsProperties)()
        rate = speed / now.time_step
        rospy.ServiceProxy(service, SetPhysicsProperties)(now.time_step, rate, now.gravity, now.ode_config)
    except (rosgraph.MasterException, rospy.ServiceException, rospy.ROSException, OSError) as error:
        rospy.logdebug("the simulator's speed is set when it starts: %s", error)
