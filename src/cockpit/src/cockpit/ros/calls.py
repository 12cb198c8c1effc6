"""Service calls with time-outs, and waiting for subscribers."""

import time
from typing import Any

import rospy

from cockpit.errors import CockpitError
from planar_ros.calls.services import ServiceError, call_service

# Time-outs for a service to appear, for its response, and for a slow response [s].
SERVICE_SECONDS, ANSWER_SECONDS, LONG_SECONDS = 1.0, 10.0, 60.0
LISTENER_SECONDS, POLL_SECONDS = 1.0, 0.02


def call(name: str, kind: Any, *arguments: Any, seconds: float = ANSWER_SECONDS) -> Any:
    """Call a service.

    Args:
        name: Name of the service.
        kind: Type of the service.
        arguments: Fields of the request, or the request.
        seconds: Longest time to wait for the response [wall s].

    Raises:
        CockpitError: The service is missing, failed, or did not respond in time.
    """
    try:
        rospy.wait_for_service(name, SERVICE_SECONDS)
        is_request = len(arguments) == 1 and isinstance(arguments[0], kind._request_class)
        request = arguments[0] if is_request else kind._request_class(*arguments)
        return call_service(name, kind, request, seconds)
    except (rospy.ROSException, ServiceError) as error:
        raise CockpitError(str(error)) from None


def wait_for_subscribers(publisher: rospy.Publisher, listeners: int) -> None:
    """Wait until subscribers are connected, for LISTENER_SECONDS at most.

    Args:
        publisher: The publisher.
        listeners: Number of subscribers to wait for.
    """
    deadline = time.monotonic() + LISTENER_SECONDS
    while time.monotonic() < deadline and publisher.get_num_connections() < listeners:
        time.sleep(POLL_SECONDS)
