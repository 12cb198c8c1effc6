"""Docking in an episode: what the robot measures goes to a DockController, its commands to the robot."""

from typing import List, Optional, Tuple

from auto_docking_lite import DockController, DockDecision, DockInputs, DockState
from planar import Pose2, Scan
from sim_bridge import Episode, EpisodeHooks, StepResult
from sim_bridge.sensors.kobuki import SECTOR_BITS
from sim_bridge.sensors.odometry import Odometer
from sim_bridge.simulation import ROBOT_NAME

# Sensors on demand that docking needs.
SENSORS = ("kobuki", "dock_ir")


class DockingHooks(EpisodeHooks):
    """Ticks a controller; commands the robot while the controller does.

    Args:
        controller: The controller.

    Attributes:
        odom_in_map: Pose of the odometry frame in the map; None while unknown.
        decision: Outcome of the latest tick.
    """

    def __init__(self, controller: DockController):
        self._controller = controller
        self.odom_in_map: Optional[Pose2] = None
        self.decision = DockDecision(None, DockState.IDLE)
        self._signals: List[Tuple[Pose2, Tuple[int, int, int]]] = []
        self._scan: Optional[Scan] = None

    def before_step(self, episode: Episode) -> None:
        robot = episode.simulation.scene.robot(ROBOT_NAME)
        for name in SENSORS:
            robot.enable_sensor(name, self._controller.is_active)

    def after_step(self, episode: Episode, step: StepResult) -> None:
        reading = step.readings.get("dock_ir")
        if reading is not None and Odometer.name in step.readings:
            self._signals.append((step.odometry.base_in_odom, reading.value))
        self._scan = step.scan or self._scan

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        kobuki, signals = step.kobuki, tuple(self._signals)
        self._signals.clear()
        if not self._controller.is_active or kobuki is None:
            self.decision = DockDecision(None, DockState.IDLE)
            return
        inputs = DockInputs(
            step.stamp,
            step.odometry.base_in_odom,
            signals,
            sum(SECTOR_BITS[sector] for sector in kobuki.bumpers),
            0 if kobuki.power is None else int(kobuki.power.charger),
            self._scan,
            self.odom_in_map,
        )
        self.decision = self._controller.tick(inputs)
        if self.decision.command is not None:
            episode.command = self.decision.command
