"""Faults of the robot and its home over ROS: those of a file, and those that are asked for meanwhile."""

from itertools import islice
from pathlib import Path
from typing import Mapping

from sim_bridge.faults import Fault, Faults, Stage, load_faults
from sim_bridge.robot import RobotWrappers, StepResult
from sim_bridge.ros.faults.asking import offer_faults
from sim_bridge.ros.orders import Orders
from sim_bridge.scene import Scene


class FaultControl:
    """``fitting``: what stands before the sensors and drives of all robots."""

    def __init__(self, path: str, seed: int, orders: Orders):
        """``path``: a YAML file; empty for none. Raises SettingsError."""
        self._faults = Faults(load_faults(Path(path)) if path else (), seed, may_come=True)
        self._now = 0.0
        self.wrappers: RobotWrappers = self._faults.wrappers
        offer_faults(lambda *asked: orders.ask(lambda: self._add(*asked)))

    def disturb(self, scene: Scene, seen: Mapping[str, StepResult]) -> None:
        """After each step, with what robots observed; a home goes wrong where the first of them is."""
        self._now = scene.stamp
        for name, observation in islice(seen.items(), 1):
            self._faults.disturb(self._now, Stage(scene, name, observation.base_in_world))

    def _add(self, kind: str, seconds: float, strength: float) -> None:
        self._faults.add(Fault(kind, self._now, self._now + seconds, strength))
