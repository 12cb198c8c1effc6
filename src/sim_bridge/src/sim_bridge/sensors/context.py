"""State of a robot and of the world around it, as its sensors measure it."""

from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2, Twist2
from planar.geometry.dock_field import ROBOT_FRONT, DockField
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.physics.vehicle import Vehicle, twist_in_base
from sim_bridge.power.system import PowerReading, PowerSystem
from sim_bridge.views.scene_view import SceneView

Wheels = Tuple[Tuple[float, ...], Tuple[float, ...]]


class RobotSensorContext:
    """The SensorContext of a vehicle, with a cache of what several sensors measure in one step.

    Args:
        vehicle: The robot.
        view: The sensors' view of the scene.
        power: Power system of the robot, if it has one.
        field: Geometry of docks.
    """

    def __init__(self, vehicle: Vehicle, view: SceneView, power: Optional[PowerSystem], field: DockField):
        self.stamp = 0.0
        self._vehicle = vehicle
        self._view = view
        self._power, self._field = power, field
        self._base: Optional[KinematicState] = None
        self._twist: Optional[Twist2] = None
        self._wheels: Optional[Wheels] = None
        self._docks: Optional[List[Pose2]] = None
        self._bumps: Dict[str, Contact] = {}

    def record_contacts(self) -> None:
        """Record what the robot touches after a physics step."""
        for bump in self._vehicle.collision_contacts():
            self._bumps[bump.link] = bump

    def clear_contacts(self) -> None:
        """Discard the recorded contacts, at the end of an odometry period."""
        self._bumps.clear()

    def refresh(self, stamp: float) -> None:
        """Discard the cached state, at the end of a physics step in which a sensor is due.

        Args:
            stamp: Simulated time [s].
        """
        self.stamp = stamp
        self._base = self._twist = self._wheels = self._docks = None

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
            self._twist = twist_in_base(self.base, self._vehicle.is_omnidirectional)
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

    def cast_rays(
        self, origin: np.ndarray, directions: np.ndarray, max_range: float
    ) -> Tuple[np.ndarray, np.ndarray]:
        lengths, links = self._vehicle.cast_rays(origin, directions, max_range)
        retros = {link: self._view.laser_retro(link) for link in set(links)}
        return lengths, np.array([retros[link] for link in links])

    def docks(self) -> List[Pose2]:
        if self._docks is None:
            self._docks = self._view.docks()
        return self._docks

    @property
    def power(self) -> Optional[PowerReading]:
        return None if self._power is None else self._power.reading(self.is_on_dock())

    def is_on_dock(self) -> bool:
        """Return whether the robot touches the contacts of a dock; only a Kobuki has the fitting ones."""
        docks = self.docks()
        if not docks or self._power is None or not self._power.profile.fits_dock:
            return False
        base, reach = self.base.pose2, 2.0 * ROBOT_FRONT + self._field.dock_contact_distance
        near = (dock for dock in docks if dock.distance_to(base) < reach)
        return any(self._field.has_contact(dock.inverse() @ base) for dock in near)

    def triangles(self) -> Tuple[np.ndarray, np.ndarray]:
        return self._view.triangles(self._vehicle.name)
