"""A robot without physics: drives take time, batteries drain, docking may fail; for plans over many days."""

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from pick_objects import DriveToPlace, GoalFailed, GoalReached
from planar import Pose2
from service.config import EnergySettings
from service.execution.robot import (
    DockingFailed,
    DockRobot,
    RobotDocked,
    RobotEvent,
    RobotInputs,
    RobotOrder,
    RobotUndocked,
    UndockRobot,
)
from service.plan.rollout import HOUR, TravelTimes


@dataclass(frozen=True)
class KinematicSettings:
    """How the robot differs from its plans.

    Attributes:
        energy: What its battery really does.
        spread: Standard deviation of the logarithm of a drive's time.
        failure: Probability that a drive fails.
        docking_failure: Probability that docking fails.
        docking_seconds: Time to dock or undock [s].
    """

    energy: EnergySettings = EnergySettings()
    spread: float = 0.15
    failure: float = 0.01
    docking_failure: float = 0.02
    docking_seconds: float = 30.0


class KinematicRobot:
    """Carries out orders in time.

    Args:
        travel: Median times of drives.
        dock: Pose in front of the dock.
        rng: Chance.
        settings: How it differs from the plans.
        pose: Where it starts; it starts in the dock, with a full battery, if that is the dock's pose.

    Attributes:
        charge: Charge of the battery, 0 to 1.
        metres: Straight-line distance driven [m].
        empty_at: Unix time at which its battery was empty [s]; None if it never was.
    """

    def __init__(
        self,
        travel: TravelTimes,
        dock: Pose2,
        rng: np.random.Generator,
        settings: KinematicSettings = KinematicSettings(),
        pose: Optional[Pose2] = None,
    ):
        self._travel, self._dock, self._rng, self._settings = travel, dock, rng, settings
        self.pose = dock if pose is None else pose
        self.is_docked, self.charge = self.pose == dock, 1.0
        self.metres = 0.0
        self.empty_at: Optional[float] = None
        self._now = -math.inf
        self._start, self._goal, self._departed = self.pose, self.pose, 0.0
        self._event: Optional[RobotEvent] = None
        self._due = math.inf

    @property
    def next_event(self) -> float:
        """Unix time of its next event [s]."""
        return self._due

    def inputs(self, now: float) -> RobotInputs:
        """Return what is known of it, after advancing to a time."""
        self._advance(now)
        return RobotInputs(self.pose, self.charge, self.is_docked)

    def event(self, now: float) -> Optional[RobotEvent]:
        """Return its event once it is due."""
        if now < self._due:
            return None
        event, self._event, self._due = self._event, None, math.inf
        self.is_docked = isinstance(event, RobotDocked) or (
            self.is_docked and not isinstance(event, RobotUndocked)
        )
        if isinstance(event, (GoalReached, RobotDocked)):
            self.metres += self.pose.distance_to(self._goal)
            self.pose = self._goal
        return event

    def carry_out(self, order: Optional[RobotOrder], now: float) -> None:
        """Begin an order, which replaces any earlier one."""
        if order is None:
            return
        self._advance(now)
        self._event, self._due = None, math.inf
        chance, settings = self._rng.random(), self._settings
        if isinstance(order, DriveToPlace):
            seconds = self._drive(order.pose, now)
            fails = chance < settings.failure
            self._event = GoalFailed("no plan") if fails else GoalReached()
            self._due = now + (seconds * self._rng.random() if fails else seconds)
        elif isinstance(order, DockRobot):
            seconds = 0.0 if self.is_docked else self._drive(self._dock, now) + settings.docking_seconds
            fails = chance < settings.docking_failure and not self.is_docked
            self._event = DockingFailed("no signal of the dock") if fails else RobotDocked()
            self._due = now + seconds
        elif isinstance(order, UndockRobot):
            self._event, self._due = RobotUndocked(), now + settings.docking_seconds

    def _drive(self, goal: Pose2, now: float) -> float:
        """Return the time of a drive [s]."""
        seconds = self._travel.seconds(self.pose, goal)
        seconds *= math.exp(self._settings.spread * self._rng.standard_normal())
        self._start, self._goal, self._departed = self.pose, goal, now
        return seconds

    def _advance(self, now: float) -> None:
        """Charge or discharge, and move along the straight line to the goal."""
        if math.isinf(self._now):
            self._now = now
        seconds, energy = max(0.0, now - self._now), self._settings.energy
        is_driving = self._event is not None and not self.is_docked
        if self.is_docked:
            self.charge = min(1.0, self.charge + seconds / (energy.charge_hours * HOUR))
        else:
            hours = energy.drive_hours if is_driving else energy.stand_hours
            self.charge = max(0.0, self.charge - seconds / (hours * HOUR))
        if self.charge <= 0.0 and self.empty_at is None:
            self.empty_at = now
        if is_driving and isinstance(self._event, GoalReached) and self._due > self._departed:
            share = min(1.0, max(0.0, (now - self._departed) / (self._due - self._departed)))
            x, y = (
                a + share * (b - a) for a, b in zip(self._start.as_array()[:2], self._goal.as_array()[:2])
            )
            moved = Pose2(float(x), float(y), self._goal.yaw)
            self.metres += self.pose.distance_to(moved)
            self.pose = moved
        self._now = now
