"""The service by which somebody asks for a fault."""

from typing import Callable, Tuple

import rospy
from sim_bridge_msgs.srv import AddFault, AddFaultResponse

from planar import PlanarError, SettingsError
from sim_bridge.faults import usual_strength, why_not_of_strength


def offer_faults(add: Callable[[str, float, float], object]) -> rospy.Service:
    """Offers ``~add_fault``: ``add(kind, seconds, strength)`` has something go wrong from now on.

    What makes no sense is refused in a sentence, and so is that for which ``add`` raises a PlanarError.
    """

    def answer(request):
        try:
            kind, seconds, strength = _checked(request)
            add(kind, seconds, strength)
        except PlanarError as error:  # there is no such kind, or other people's fails
            return AddFaultResponse(False, str(error))
        rospy.loginfo("fault: %s of strength %g", kind, strength)
        return AddFaultResponse(True, "")

    return rospy.Service("~add_fault", AddFault, answer)


def _checked(request) -> Tuple[str, float, float]:
    """Kind, seconds and strength, with what 0 stands for. Raises SettingsError."""
    strength = request.strength or usual_strength(request.kind)
    expected = why_not_of_strength(request.kind, strength)
    if expected is not None:
        raise SettingsError(f"strength must be {expected}")
    if not request.seconds >= 0.0:
        raise SettingsError("seconds must not be negative")
    return request.kind, request.seconds or float("inf"), strength
