"""Pure pursuit (Coulter, 1992): an arc to a lookahead point of the plan."""

import math
from dataclasses import dataclass

import numpy as np

from move_base_lite import ControlContext, ControlError, ControllerSettings, Plan, Trajectory
from planar import Pose2, Twist2
from planar.config.parameters import POSITIVE, parameter

# Length and steps of the predicted arc [m].
MAX_ARC_LENGTH, STEPS = 0.3, 6


@dataclass(frozen=True)
class PurePursuitSettings(ControllerSettings):
    """Distance to the lookahead point."""

    lookahead: float = parameter(0.4, "distance to the lookahead point", "m", POSITIVE, dynamic=5.0)


class PurePursuit:
    """Local planner that drives an arc through a lookahead point of the plan.

    Args:
        settings: Distance to the lookahead point.
        period: Control period [s].
    """

    Settings = PurePursuitSettings

    def __init__(self, settings: PurePursuitSettings, period: float):
        self._settings, self._period = settings, period

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Return the arc to the lookahead point.

        Args:
            context: Robot state and costmaps.
            plan: Rest of the global plan.
            limits: Largest speed and turn rate [m/s, rad/s].

        Raises:
            ControlError: The arc collides.
        """
        base = context.base_in_local
        apart = np.hypot(plan.path_xy[:, 0] - base.x, plan.path_xy[:, 1] - base.y)
        ahead = plan.path_xy[int(np.argmax(apart >= self._settings.lookahead)) or -1]
        x, y = base.inverse().transform_points(ahead[None, :])[0]
        curvature = 2.0 * y / max(x * x + y * y, 1e-6)
        v = min(limits.v, limits.omega / max(abs(curvature), 1e-6))
        command = self._settings.reachable(context.twist, Twist2(v, v * curvature), limits, self._period)
        poses = arc(base, command, min(MAX_ARC_LENGTH, math.hypot(x, y)) / max(command.v, 0.1), STEPS)
        if any(context.costmap.collides(Pose2(*pose)) for pose in poses[1:].tolist()):
            raise ControlError("the arc to the plan leads into an obstacle")
        return Trajectory(command, poses, math.hypot(x, y))


def arc(base: Pose2, command: Twist2, seconds: float, steps: int) -> np.ndarray:
    """Return the poses of a robot that drives a constant command.

    Args:
        base: Start pose.
        command: Speed and turn rate [m/s, rad/s].
        seconds: Duration [s].
        steps: Number of intervals.

    Returns:
        x, y, yaw (steps + 1, 3) in the frame of ``base``'s coordinates.
    """
    poses, dt = [base], seconds / steps
    for _ in range(steps):
        poses.append(poses[-1] @ Pose2(command.v * dt, 0.0, command.omega * dt))
    return np.array([pose.as_array() for pose in poses])
