"""TITLE: a local planner for move_base_lite."""

from dataclasses import dataclass

import numpy as np

from move_base_lite import ControlContext, ControlError, ControllerSettings, Plan, Trajectory
from planar import Pose2, Twist2
from planar.config.parameters import POSITIVE, parameter


@dataclass(frozen=True)
class Settings(ControllerSettings):
    """Parameters in addition to those of every local planner, read from the namespace CLASS."""

    gain: float = parameter(1.5, "turn rate per radian of heading error", "1/s", POSITIVE, dynamic=5.0)


class CLASS:
    """Turns towards a point of the plan and drives faster the better it is aligned."""

    Settings = Settings

    def __init__(self, settings: Settings, period: float):
        self._settings, self._period = settings, period

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """See move_base_lite.LocalPlanner; raise ControlError if no velocity is safe."""
        base = context.base_in_local
        ahead = base.inverse().transform_points(plan.path_xy[min(6, len(plan.path_xy) - 1)][None, :])[0]
        error = float(np.arctan2(ahead[1], ahead[0]))
        target = Twist2(limits.v * max(np.cos(error), 0.0), self._settings.gain * error)
        command = self._settings.reachable(context.twist, target, limits, self._period)
        end = base @ Pose2(0.3 * command.v, 0.0, 0.3 * command.omega)
        if context.costmap.collides(end):
            raise ControlError("an obstacle is ahead")
        return Trajectory(command, np.array([base.as_array(), end.as_array()]), abs(error))
