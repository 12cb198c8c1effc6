"""An artificial potential field (Khatib, 1986): the plan attracts, costs repel."""

import math
from dataclasses import dataclass

import numpy as np

from move_base_lite import ControlContext, ControlError, ControllerSettings, Plan, Trajectory
from planar import Pose2, Twist2, wrap
from planar.config.parameters import POSITIVE, at_least, parameter
from plugin_examples.pure_pursuit import arc

# Length and steps of the predicted arc [m].
MAX_ARC_LENGTH, STEPS = 0.3, 6
# Turn rate per radian off the direction of the force [1/s].
TURN_GAIN = 2.0


@dataclass(frozen=True)
class PotentialFieldSettings(ControllerSettings):
    """Attracting point and strength of the repulsion."""

    lookahead: float = parameter(
        0.5, "distance along the plan to the attracting point", "m", POSITIVE, dynamic=5.0
    )
    repulsion: float = parameter(0.6, "maximum repulsion, relative to the attraction", "", at_least(0.0))


class PotentialField:
    """Local planner that drives along the sum of an attracting and a repelling force.

    Args:
        settings: Attracting point and strength of the repulsion.
        period: Control period [s].
    """

    Settings = PotentialFieldSettings

    def __init__(self, settings: PotentialFieldSettings, period: float):
        self._settings, self._period = settings, period

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Return an arc that turns towards the force.

        Args:
            context: Robot state and costmaps.
            plan: Rest of the global plan.
            limits: Largest speed and turn rate [m/s, rad/s].

        Raises:
            ControlError: The arc collides.
        """
        base = context.base_in_local
        apart = np.hypot(plan.path_xy[:, 0] - base.x, plan.path_xy[:, 1] - base.y)
        target_xy = plan.path_xy[int(np.argmax(apart >= self._settings.lookahead)) or -1] - (base.x, base.y)
        force_x, force_y = target_xy / max(np.hypot(*target_xy), 1e-6) - self._repulsion(context)
        error = wrap(math.atan2(force_y, force_x) - base.yaw)
        v = limits.v * max(math.cos(error), 0.0) ** 2
        omega = max(-limits.omega, min(limits.omega, TURN_GAIN * error))
        command = self._settings.reachable(context.twist, Twist2(v, omega), limits, self._period)
        reach = min(MAX_ARC_LENGTH, float(np.hypot(*target_xy)))
        poses = arc(base, command, reach / max(command.v, 0.1), STEPS)
        if any(context.costmap.collides(Pose2(*pose)) for pose in poses[1:].tolist()):
            raise ControlError("the arc to the plan leads into an obstacle")
        return Trajectory(command, poses, 1.0 - math.cos(error))

    def _repulsion(self, context: ControlContext) -> np.ndarray:
        """Gradient of the costs around the robot (2,), clipped and scaled by ``repulsion``."""
        costs, window = context.costmap.costs, context.costmap.window
        row, col = window.cell_of(context.base_in_local.x, context.base_in_local.y)
        if not (3 <= row < window.rows - 3 and 3 <= col < window.cols - 3):
            return np.zeros(2)
        patch = costs[row - 3 : row + 4, col - 3 : col + 4].astype(float) / 254.0
        across, along = patch[:, 4:] - patch[:, 2::-1], patch[4:] - patch[2::-1]
        slope = np.array([across.mean(), along.mean()])
        return self._settings.repulsion * np.clip(slope, -1.0, 1.0)
