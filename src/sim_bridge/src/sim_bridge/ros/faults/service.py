"""The service ``~add_fault``, and the faults of the simulator."""

from itertools import islice
from pathlib import Path
from typing import Callable, Mapping, Tuple

import rospy
from sim_bridge_msgs.srv import AddFault, AddFaultResponse

from planar import PlanarError, SettingsError
from sim_bridge.faults import (
    Fault,
    FaultContext,
    FaultInjector,
    default_strength,
    load_faults,
    strength_error,
)
from sim_bridge.robot import RobotWrappers, StepResult
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.scene import Scene


class FaultServer:
    """Injects faults into the simulator: those of a file, and those that are added by the service.

    Args:
        path: YAML file of faults; empty for none.
        seed: Seed of the run.
        calls: Queue of the thread that owns the scene.

    Attributes:
        wrappers: Wrappers of the sensors and drives of all robots.

    Raises:
        SettingsError: The file has an error.
    """

    def __init__(self, path: str, seed: int, calls: CallQueue):
        self._injector = FaultInjector(load_faults(Path(path)) if path else (), seed, extendable=True)
        self._now = 0.0
        self.wrappers: RobotWrappers = self._injector.wrappers
        advertise_add_fault(lambda *fault: calls.call(lambda: self._add(*fault)))

    def update(self, scene: Scene, observations: Mapping[str, StepResult]) -> None:
        """Begin and end faults after a step.

        Args:
            scene: The simulated world.
            observations: Result of the step by robot; faults of the environment concern the first one.
        """
        self._now = scene.stamp
        for name, observation in islice(observations.items(), 1):
            self._injector.update(self._now, FaultContext(scene, name, observation.base_in_world))

    def are_inactive(self, start: float, end: float) -> bool:
        """Return whether no fault is active at any time between two simulated times [s]."""
        return self._injector.are_inactive(start, end)

    def _add(self, kind: str, seconds: float, strength: float) -> None:
        self._injector.add(Fault(kind, self._now, self._now + seconds, strength))


def advertise_add_fault(add: Callable[[str, float, float], object]) -> rospy.Service:
    """Advertise ``~add_fault``.

    Args:
        add: Called with kind, seconds and strength to start a fault; a PlanarError that it raises is the
            answer's message.
    """

    def answer(request):
        try:
            kind, seconds, strength = _checked(request)
            add(kind, seconds, strength)
        except PlanarError as error:  # an unknown kind, or a failure of a user-defined one
            return AddFaultResponse(False, str(error))
        rospy.loginfo("fault: %s of strength %g", kind, strength)
        return AddFaultResponse(True, "")

    return rospy.Service("~add_fault", AddFault, answer)


def _checked(request) -> Tuple[str, float, float]:
    """Return kind, seconds and strength with defaults in place of 0. Raises SettingsError."""
    strength = request.strength or default_strength(request.kind)
    expected = strength_error(request.kind, strength)
    if expected is not None:
        raise SettingsError(f"strength must be {expected}")
    if not request.seconds >= 0.0:
        raise SettingsError("seconds must not be negative")
    return request.kind, request.seconds or float("inf"), strength
