"""A robot and the world as its sensors perceive them."""

from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.physics.vehicle import Vehicle, twist_in_base
from sim_bridge.views.scene_view import SceneView

Wheels = Tuple[Tuple[float, ...], Tuple[float, ...]]


class RobotSurroundings:
    """Surroundings of a vehicle; what several sensors ask for is asked of physics once a moment."""

    def __init__(self, vehicle: Vehicle, view: SceneView):
        self.stamp = 0.0
        self._vehicle = vehicle
        self._view = view
        self._base: Optional[KinematicState] = None
        self._twist: Optional[Twist2] = None
        self._wheels: Optional[Wheels] = None
        self._bumps: Dict[str, Contact] = {}

    def feel(self) -> None:
        """Notes what is touched after a step of physics."""
        for bump in self._vehicle.collision_contacts():
            self._bumps[bump.link] = bump

    def look_anew(self, stamp: float) -> None:
        """It is now ``stamp``, s, at the end of a step of physics in which something is due."""
        self.stamp = stamp
        self._base = self._twist = self._wheels = None

    def end_period(self) -> None:
        """What has been touched so far has been told."""
        self._bumps.clear()

    @property
    def gravity(self) -> float:
        return self._vehicle.gravity

    @property
    def base(self) -> KinematicState:
        if self._base is None:
            self._base = self._vehicle.state()
        return self._base

    @property
    def twist(self) -> Twist2:
        if self._twist is None:
            self._twist = twist_in_base(self.base)
        return self._twist

    @property
    def wheels(self) -> Wheels:
        if self._wheels is None:
            self._wheels = self._vehicle.wheels()
        return self._wheels

    @property
    def bumps(self) -> Sequence[Contact]:
        return list(self._bumps.values())

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        return self._vehicle.floors_below(points)

    def section(self, height: float) -> Tuple[np.ndarray, np.ndarray]:
        return self._view.section(self._vehicle.name, height)

    def triangles(self) -> Tuple[np.ndarray, np.ndarray]:
        return self._view.triangles(self._vehicle.name)
