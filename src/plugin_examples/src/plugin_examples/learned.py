"""Pure pursuit with what evolution has added: a small network that was trained in Gymnasium's PointGoal-v0.

It steers for a point of the plan; the network sees how far it is to what is solid all around, where that
point lies and how fast the robot goes, and changes speed and turn ("residual policy learning", Silver et al.,
2018). ``scripts/train.sh`` trains the weights, learned.npz; at run time there is numpy and nothing else.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from move_base_lite import ControlContext, ControlError, ControllerSettings, Plan, Trajectory
from move_base_lite.costmap import LETHAL
from planar import OCCUPIED, OccupancyGrid, Pose2, Twist2
from planar.geometry.ray_casting import cast_rays
from plugin_examples.pure_pursuit import arc

WEIGHTS = Path(__file__).with_name("learned.npz")
# Sectors around the robot and beams in each, how far is looked, and along the plan to what is steered for, m.
SECTORS, BEAMS, SIGHT, LOOKAHEAD = 24, 5, 1.5, 0.6
# Shares of the highest turn rate for a radian that the robot looks away; of speeds that are tried in turn.
TURN_GAIN, SLOWER = 1.2, (1.0, 0.5, 0.2)
HIDDEN, INPUTS, OUTPUTS = 16, SECTORS + 5, 2
FARTHEST, STEPS = 0.3, 6
ANGLES = (np.arange(SECTORS * BEAMS) + 0.5) * (2.0 * math.pi / (SECTORS * BEAMS)) - math.pi


class Seen(NamedTuple):
    """``clear``: (SECTORS,), m, from the one behind on the right round to the left.

    ``x``, ``y``: of the point to steer for, seen from the base. ``v``, ``omega``: as shares of the highest.
    """

    clear: np.ndarray
    x: float
    y: float
    v: float
    omega: float


class Policy:
    """``weights``: (COUNT,), all of the network's in a row; with the LAST zero it is pure pursuit."""

    LAST = OUTPUTS * (HIDDEN + 1)
    COUNT = HIDDEN * (INPUTS + 1) + LAST

    def __init__(self, weights: np.ndarray):
        first, last = np.split(weights, [HIDDEN * (INPUTS + 1)])
        self._first, self._last = first.reshape(HIDDEN, -1), last.reshape(OUTPUTS, -1)

    def act(self, seen: Seen) -> np.ndarray:
        """Shares of the highest speed, from 0, and turn rate, from -1, to 1: (2,)."""
        bearing = math.atan2(seen.y, seen.x)
        reach = min(math.hypot(seen.x, seen.y), 1.0)
        told = (math.cos(bearing), math.sin(bearing), reach, seen.v, seen.omega)
        inputs = np.concatenate((1.0 - np.minimum(seen.clear, SIGHT) / SIGHT, told))
        hidden = np.tanh(self._first[:, :-1] @ inputs + self._first[:, -1])
        faster, left = self._last[:, :-1] @ hidden + self._last[:, -1]
        ahead = max(math.cos(bearing), 0.0) ** 2
        return np.array([np.clip(ahead + faster, 0.0, 1.0), np.clip(TURN_GAIN * bearing + left, -1.0, 1.0)])


class Learned:
    def __init__(self, settings: ControllerSettings, period: float):
        self._settings, self._period = settings, period
        self._policy = Policy(np.load(WEIGHTS)["weights"])

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        base, twist = context.base_in_local, context.twist
        apart = np.hypot(plan.path_xy[:, 0] - base.x, plan.path_xy[:, 1] - base.y)
        ahead = plan.path_xy[int(np.argmax(apart >= LOOKAHEAD)) or -1]
        x, y = base.inverse().transform_points(ahead[None, :])[0].tolist()
        seen = Seen(clear_around(context), x, y, twist.v / limits.v, twist.omega / limits.omega)
        v, omega = (self._policy.act(seen) * (limits.v, limits.omega)).tolist()
        for share in SLOWER:
            command = self._settings.reachable(twist, Twist2(share * v, omega), limits, self._period)
            poses = arc(base, command, min(FARTHEST, math.hypot(x, y)) / max(command.v, 0.1), STEPS)
            if not any(context.costmap.collides(Pose2(*pose)) for pose in poses[1:].tolist()):
                return Trajectory(command, poses, math.hypot(x, y))
        raise ControlError("the way to the plan leads into an obstacle")


def clear_around(context: ControlContext) -> np.ndarray:
    """How far it is in each sector to what the costmap has as solid, (SECTORS,), m."""
    costmap = context.costmap
    cells = np.where(costmap.costs == LETHAL, OCCUPIED, 0).astype(np.int8)
    window = costmap.window
    grid = OccupancyGrid(cells, window.resolution, Pose2(window.origin_x, window.origin_y))
    return cast_rays(grid, context.base_in_local, ANGLES, SIGHT).reshape(SECTORS, BEAMS).min(axis=1)
