"""Services, called, and topics, joined."""

import time
from typing import Any

import rospy

from cockpit.errors import CockpitError

# So long is waited for a service to be there.
SERVICE_SECONDS = 1.0
LISTENER_SECONDS, POLL_SECONDS = 1.0, 0.02


def call(name: str, kind: type, *arguments: Any) -> Any:
    """The answer. Raises CockpitError if there is none."""
    try:
        rospy.wait_for_service(name, SERVICE_SECONDS)
        return rospy.ServiceProxy(name, kind)(*arguments)
    except (rospy.ROSException, rospy.ServiceException) as error:
        raise CockpitError(f"{name}: {error}") from None


def join(publisher: rospy.Publisher, listeners: int) -> None:
    """Gives those who listen the time to find it."""
    deadline = time.monotonic() + LISTENER_SECONDS
    while time.monotonic() < deadline and publisher.get_num_connections() < listeners:
        time.sleep(POLL_SECONDS)
