"""Services, called."""

from typing import Any

import rospy

from cockpit.errors import CockpitError

# So long is waited for a service to be there.
SERVICE_SECONDS = 1.0


def call(name: str, kind: type, *arguments: Any) -> Any:
    """The answer. Raises CockpitError if there is none."""
    try:
        rospy.wait_for_service(name, SERVICE_SECONDS)
        return rospy.ServiceProxy(name, kind)(*arguments)
    except (rospy.ROSException, rospy.ServiceException) as error:
        raise CockpitError(f"{name}: {error}") from None
