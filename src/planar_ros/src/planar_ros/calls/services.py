"""Service calls with a time-out."""

import queue
import threading

import rospy

from planar import PlanarError
from planar_ros.lockstep import LockstepClient


class ServiceError(PlanarError):
    """A service is unavailable, times out or fails; the text names the service and the reason."""


def call_service(name: str, kind, request, seconds: float):
    """Call a service with a time-out.

    Args:
        name: Service name.
        kind: Service type.
        request: The request.
        seconds: Longest wall-clock time to wait for the response [s].

    Returns:
        The response.

    Raises:
        ServiceError: If the service is unavailable, times out or fails.
    """
    answers: queue.Queue = queue.Queue()
    step = LockstepClient.existing()
    headers = {} if step is None else step.headers()

    def call():
        try:
            answers.put((rospy.ServiceProxy(name, kind, headers=headers)(request), None))
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            answers.put((None, error))

    threading.Thread(target=call, daemon=True).start()
    resolved = rospy.resolve_name(name)
    try:
        response, error = answers.get(timeout=seconds)
    except queue.Empty:
        raise ServiceError(f"no answer of the service {resolved} within {seconds:g} s") from None
    if error is not None:
        raise ServiceError(f"service {resolved}: {error}") from None
    return response
