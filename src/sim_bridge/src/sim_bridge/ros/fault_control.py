"""Faults of the robot and its home over ROS: those of a file, and those that are asked for meanwhile."""

from itertools import islice
from pathlib import Path
from typing import Mapping

import rospy
from sim_bridge_msgs.srv import AddFault, AddFaultResponse

from planar import PlanarError
from sim_bridge.faults import (
    Fault,
    Faults,
    Stage,
    load_faults,
    usual_strength,
    why_not_of_strength,
)
from sim_bridge.robot import Fitting, Observation
from sim_bridge.ros.orders import Orders
from sim_bridge.scene import Scene


class FaultControl:
    """``fitting``: what stands before the sensors and drives of all robots."""

    def __init__(self, path: str, seed: int, orders: Orders):
        """``path``: a YAML file; empty for none. Raises SettingsError."""
        self._faults = Faults(load_faults(Path(path)) if path else (), seed, may_come=True)
        self._orders = orders
        self._now = 0.0
        self.fitting: Fitting = self._faults.fitting
        rospy.Service("~add_fault", AddFault, self._on_fault)

    def disturb(self, scene: Scene, seen: Mapping[str, Observation]) -> None:
        """After each step, with what robots observed; a home goes wrong where the first of them is."""
        self._now = scene.stamp
        for name, observation in islice(seen.items(), 1):
            self._faults.disturb(self._now, Stage(scene, name, observation.base_in_world))

    def _on_fault(self, request):
        try:
            return self._asked_for(request)
        except PlanarError as error:  # there is no such kind, or other people's fails
            return AddFaultResponse(False, str(error))

    def _asked_for(self, request):
        strength = request.strength or usual_strength(request.kind)
        expected = why_not_of_strength(request.kind, strength)
        if expected is not None:
            return AddFaultResponse(False, f"strength must be {expected}")
        if not request.seconds >= 0.0:
            return AddFaultResponse(False, "seconds must not be negative")
        return self._orders.ask(lambda: self._add(request.kind, request.seconds or float("inf"), strength))

    def _add(self, kind: str, seconds: float, strength: float):
        self._faults.add(Fault(kind, self._now, self._now + seconds, strength))
        rospy.loginfo("fault: %s of strength %g", kind, strength)
        return AddFaultResponse(True, "")
