"""Service calls with time-outs, and waiting for subscribers."""

import time
from typing import Any

import rospy

from cockpit.errors import CockpitError
from planar_ros.calls.services import ServiceError, call_service
from planar_ros.node.topics import unconnected_subscribers

# Time-outs for a service to appear, for its response, and for a slow response [s].
SERVICE_SECONDS, ANSWER_SECONDS, LONG_SECONDS = 1.0, 10.0, 60.0
CONNECT_SECONDS, POLL_SECONDS = 5.0, 0.02


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


def wait_for_subscribers(publisher: rospy.Publisher) -> None:
    """Wait until every node that subscribes to the topic is connected.

    Raises:
        CockpitError: A subscriber did not connect within CONNECT_SECONDS.
    """
    deadline = time.monotonic() + CONNECT_SECONDS
    while missing := unconnected_subscribers(publisher):
        if time.monotonic() > deadline:
            raise CockpitError(
                f"{', '.join(missing)}: subscribed to {publisher.resolved_name}, but did not connect within "
                f"{CONNECT_SECONDS:g} s; nothing was sent, try again"
            )
        time.sleep(POLL_SECONDS)
