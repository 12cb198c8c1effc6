"""A robot without dynamics before a dock, for tests without a simulator."""

import math
from typing import List, Optional

import numpy as np

from auto_docking_lite import DockController, DockDecision, DockInputs, DockResult
from planar import Pose2, Scan, Twist2
from planar.geometry.dock_field import ROBOT_FRONT, DockField

PERIOD, STEPS = 0.1, 5


class RobotAtDock:
    """Moves as commanded; stops at the dock's front.

    Args:
        controller: Docks the robot.
        base_in_dock: Start pose in the frame of the dock.
        field: Field of the dock; None for a dock without one.
        charges: Whether the contacts work.
        obstacles_xy: Obstacles (N, 2) in the dock's frame, which the scan shows.

    Attributes:
        odom_in_map: Pose of the odometry frame in the map.
    """

    def __init__(
        self,
        controller: DockController,
        base_in_dock: Pose2,
        field: Optional[DockField] = DockField(),
        charges: bool = True,
        obstacles_xy: np.ndarray = np.empty((0, 2)),
    ):
        self.controller, self.base, self._start = controller, base_in_dock, base_in_dock
        self.field, self.charges, self.obstacles_xy = field, charges, obstacles_xy
        self.now, self.states, self.odom_in_map = 0.0, [""], Pose2()

    @property
    def dock_in_odom(self) -> Pose2:
        """Pose of the dock where the robot's odometry started."""
        return self._start.inverse()

    def tick(self, navigation_moves: Optional[Pose2] = None) -> DockDecision:
        """Advance by one control period."""
        contact = self.charges and DockField().has_contact(self.base)
        front = self.base @ Pose2(ROBOT_FRONT)
        is_bumped = abs(front.y) < 0.1 and front.x <= 0.001 and not contact
        signals = self.field.signals(self.base) if self.field is not None else (0, 0, 0)
        odom = self.dock_in_odom @ self.base
        inputs = DockInputs(
            self.now,
            odom,
            ((odom, signals),),
            2 if is_bumped else 0,
            6 if contact else 0,
            self._scan(),
            self.odom_in_map,
        )
        decision = self.controller.tick(inputs)
        self._move(decision.command or Twist2())
        self.now += PERIOD
        if self.states[-1] != decision.state.value:
            self.states.append(decision.state.value)
        return decision

    def run(self, seconds: float = 300.0) -> Optional[DockResult]:
        """Tick until the task ends; None if it does not end in time."""
        while self.now < seconds:
            result = self.tick().result
            if result is not None:
                return result
        return None

    def _move(self, command: Twist2) -> None:
        for _ in range(STEPS):
            step = PERIOD / STEPS
            moved = self.base @ Pose2(command.v * step, 0.0, command.omega * step)
            front = moved @ Pose2(ROBOT_FRONT)
            if command.v > 0.0 and front.x < 0.0 and abs(front.y) < 0.1:
                return
            self.base = moved

    def _scan(self) -> Scan:
        ranges: List[float] = [math.inf] * 360
        for x, y in self.base.inverse().transform_points(self.obstacles_xy):
            beam = int(round(math.degrees(math.atan2(y, x)))) % 360
            ranges[beam] = min(ranges[beam], math.hypot(x, y))
        return Scan(self.now, 0.0, math.radians(1.0), np.array(ranges), 0.05, 10.0)
