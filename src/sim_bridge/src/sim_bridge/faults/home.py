"""Faults of the environment: the robot is displaced, or an obstacle appears."""

import math
from itertools import chain, count
from typing import ClassVar, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.faults.kind import FaultContext, FaultKind
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.simulation import box_on_floor

# Fractions of the displacement to try: the first at which the robot overlaps nothing is used.
DISPLACEMENT_FRACTIONS = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)


class Kidnapped(FaultKind):
    """The robot is displaced sideways.

    The displacement is shortened as far as needed to leave the robot free of obstacles.
    """

    strength = (0.5, -10.0, 10.0)
    unit = "m"

    def begin(self, context: FaultContext) -> None:
        height = _height(context)
        for fraction in DISPLACEMENT_FRACTIONS:
            _place(context, context.base_in_world @ Pose2(0.0, fraction * self._strength), height)
            if context.scene.robot(context.robot).vehicle.overlap() is None:
                return


class TurnedRound(FaultKind):
    """The robot is rotated in place, without its wheels turning."""

    strength = (45.0, -180.0, 180.0)
    unit = "degrees"

    def begin(self, context: FaultContext) -> None:
        base_in_world = context.base_in_world @ Pose2(yaw=math.radians(self._strength))
        _place(context, base_in_world, _height(context))


class ObstacleAhead(FaultKind):
    """Base class of faults that put a box ahead of the robot, at a distance of ``strength``.

    Attributes:
        name: Name of the model; if it is taken, a number is appended.
        size: Lengths along x, y and z [m].
    """

    unit = "m"
    name: ClassVar[str]
    size: ClassVar[Tuple[float, float, float]]

    def begin(self, context: FaultContext) -> None:
        taken = context.scene.models.names()
        names = chain([self.name], (f"{self.name}_{number}" for number in count(2)))
        self._model = next(name for name in names if name not in taken)
        box_in_world = context.base_in_world @ Pose2(self._strength, 0.0)
        context.scene.add([box_on_floor(self._model, self.size, box_in_world)])

    def end(self, context: FaultContext) -> None:
        if self._model in context.scene.models.names():  # it may have been deleted meanwhile
            context.scene.remove_model(self._model)


class ObjectInWay(ObstacleAhead):
    """A box appears ahead of the robot, at this distance."""

    strength = (1.0, 0.5, 10.0)
    name, size = "fault_box", (0.3, 0.3, 0.6)


class WayClosed(ObstacleAhead):
    """A wall appears across the path ahead of the robot, at this distance."""

    strength = (1.0, 0.5, 10.0)
    name, size = "fault_wall", (0.1, 1.6, 1.0)


def _height(context: FaultContext) -> float:
    return float(context.scene.models.state(context.robot).pose[2, 3])


def _place(context: FaultContext, base_in_world: Pose2, height: float) -> None:
    """Put the robot at a pose, at rest."""
    at_rest = KinematicState(from_pose2(base_in_world, z=height), np.zeros(3), np.zeros(3))
    context.scene.set_model_state(context.robot, at_rest)
