"""Speed of the simulator while it runs, or before it starts."""

import threading
from typing import Optional

import rosgraph
import rospy
from gazebo_msgs.srv import (
    GetPhysicsProperties,
    GetPhysicsPropertiesRequest,
    SetPhysicsProperties,
    SetPhysicsPropertiesRequest,
)

from planar_ros.calls.services import ServiceError, call_service

SIMULATOR = "/gazebo"
# Time limit of a service call, and time between two attempts [wall s].
ANSWER_SECONDS, RETRY_SECONDS = 10.0, 0.2


class SimulatorSpeed:
    """Sets the speed of the simulator, also of one that starts later, in a separate thread.

    A simulator that is starting has read the parameter already, but has no services yet: the service is
    called until it answers.
    """

    def __init__(self):
        self._speed: Optional[float] = None
        self._is_changed = threading.Event()
        self._thread: Optional[threading.Thread] = None

    def set(self, speed: float) -> None:
        """Set the speed.

        Args:
            speed: Multiple of real time; 0 for no limit.
        """
        rospy.set_param(f"{SIMULATOR}/speed", speed)
        self._speed = speed
        self._is_changed.set()
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, daemon=True)
            self._thread.start()

    def _run(self) -> None:
        taken = None
        while not rospy.is_shutdown():
            self._is_changed.clear()
            speed = self._speed
            if speed is not None and speed != taken and set_physics_speed(speed):
                taken = speed
            self._is_changed.wait(RETRY_SECONDS)


def set_physics_speed(speed: float) -> bool:
    """Set the speed of a simulator that runs; return False if it does not answer yet.

    Args:
        speed: Multiple of real time; 0 for no limit.
    """
    getter, setter = f"{SIMULATOR}/get_physics_properties", f"{SIMULATOR}/set_physics_properties"
    try:
        rosgraph.Master(rospy.get_name()).lookupService(setter)
        now = call_service(getter, GetPhysicsProperties, GetPhysicsPropertiesRequest(), ANSWER_SECONDS)
        request = SetPhysicsPropertiesRequest(
            now.time_step, speed / now.time_step, now.gravity, now.ode_config
        )
        return bool(call_service(setter, SetPhysicsProperties, request, ANSWER_SECONDS).success)
    except (rosgraph.MasterException, ServiceError, OSError) as error:
        rospy.logdebug("the simulator does not take its speed yet: %s", error)
        return False
