"""Ask the simulator why simulated time stands still."""

from typing import Sequence

from gazebo_msgs.srv import GetPhysicsProperties, GetPhysicsPropertiesRequest

from planar_ros.calls.services import ServiceError, call_service

# Time-out of the simulator's answer [s].
ANSWER_SECONDS = 3.0


def why_clock_stopped(waiting_for: Sequence[str]) -> str:
    """Ask the simulator why time stands still; ``waiting_for``: nodes that it has published to wait for."""
    request, name = GetPhysicsPropertiesRequest(), "/gazebo/get_physics_properties"
    try:
        is_paused = call_service(name, GetPhysicsProperties, request, ANSWER_SECONDS).pause
    except ServiceError as error:
        return f"the simulator does not answer ({error})"
    if is_paused:
        return "the simulation is paused"
    return f"the simulator waits for {', '.join(waiting_for) or 'nodes (see doctor.sh)'}"
