"""Pure pursuit corrected by a small neural network (residual policy learning, Silver et al., 2018).

Input: the clearance in each sector, the lookahead point and the velocity; output: changes of speed and turn
rate. ``scripts/train.sh`` trains the weights, learned.npz, in the environment PointGoal-v0 with an evolution
strategy; at run time only numpy is needed.
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
# Sectors around the robot, rays per sector, range of the clearance and lookahead along the plan [m].
SECTORS, BEAMS, VIEW_RANGE, LOOKAHEAD = 24, 5, 1.5, 0.6
# Share of the maximum turn rate per radian of bearing, and the speeds that are tried in turn.
TURN_GAIN, SPEED_SHARES = 1.2, (1.0, 0.5, 0.2)
HIDDEN, INPUTS, OUTPUTS = 16, SECTORS + 5, 2
MAX_ARC_LENGTH, STEPS = 0.3, 6
ANGLES = (np.arange(SECTORS * BEAMS) + 0.5) * (2.0 * math.pi / (SECTORS * BEAMS)) - math.pi


class PolicyObservation(NamedTuple):
    """Input of the policy.

    Attributes:
        clearances: Distance to obstacles (SECTORS,) [m], counter-clockwise from behind the robot.
        x: Lookahead point in the base frame, ahead [m].
        y: Lookahead point in the base frame, to the left [m].
        v: Speed as a share of the maximum.
        omega: Turn rate as a share of the maximum.
    """

    clearances: np.ndarray
    x: float
    y: float
    v: float
    omega: float


class Policy:
    """A network with one hidden layer; with a zero output layer it is pure pursuit.

    Args:
        weights: Weights (WEIGHT_COUNT,), hidden layer first.
    """

    LAST_LAYER_SIZE = OUTPUTS * (HIDDEN + 1)
    WEIGHT_COUNT = HIDDEN * (INPUTS + 1) + LAST_LAYER_SIZE

    def __init__(self, weights: np.ndarray):
        first, last = np.split(weights, [HIDDEN * (INPUTS + 1)])
        self._first, self._last = first.reshape(HIDDEN, -1), last.reshape(OUTPUTS, -1)

    def act(self, observation: PolicyObservation) -> np.ndarray:
        """Return speed and turn rate as shares of the maximum.

        Returns:
            Speed in [0, 1] and turn rate in [-1, 1], (2,).
        """
        bearing = math.atan2(observation.y, observation.x)
        reach = min(math.hypot(observation.x, observation.y), 1.0)
        rest = (math.cos(bearing), math.sin(bearing), reach, observation.v, observation.omega)
        inputs = np.concatenate((1.0 - np.minimum(observation.clearances, VIEW_RANGE) / VIEW_RANGE, rest))
        hidden = np.tanh(self._first[:, :-1] @ inputs + self._first[:, -1])
        faster, left = self._last[:, :-1] @ hidden + self._last[:, -1]
        ahead = max(math.cos(bearing), 0.0) ** 2
        return np.array([np.clip(ahead + faster, 0.0, 1.0), np.clip(TURN_GAIN * bearing + left, -1.0, 1.0)])


class Learned:
    """Local planner that drives by the policy with trained weights.

    Args:
        settings: Accelerations of the robot.
        period: Control period [s].
    """

    def __init__(self, settings: ControllerSettings, period: float):
        self._settings, self._period = settings, period
        self._policy = Policy(np.load(WEIGHTS)["weights"])

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Return the arc of the policy's command, slower if it would collide.

        Args:
            context: Robot state and costmaps.
            plan: Rest of the global plan.
            limits: Largest speed and turn rate [m/s, rad/s].

        Raises:
            ControlError: The arc collides at every speed.
        """
        base, twist = context.base_in_local, context.twist
        apart = np.hypot(plan.path_xy[:, 0] - base.x, plan.path_xy[:, 1] - base.y)
        ahead = plan.path_xy[int(np.argmax(apart >= LOOKAHEAD)) or -1]
        x, y = base.inverse().transform_points(ahead[None, :])[0].tolist()
        observation = PolicyObservation(
            sector_clearances(context), x, y, twist.v / limits.v, twist.omega / limits.omega
        )
        v, omega = (self._policy.act(observation) * (limits.v, limits.omega)).tolist()
        for share in SPEED_SHARES:
            command = self._settings.reachable(twist, Twist2(share * v, omega), limits, self._period)
            poses = arc(base, command, min(MAX_ARC_LENGTH, math.hypot(x, y)) / max(command.v, 0.1), STEPS)
            if not any(context.costmap.collides(Pose2(*pose)) for pose in poses[1:].tolist()):
                return Trajectory(command, poses, math.hypot(x, y))
        raise ControlError("the arc to the plan leads into an obstacle")


def sector_clearances(context: ControlContext) -> np.ndarray:
    """Return the distance (SECTORS,) to the nearest lethal cell in each sector [m]."""
    costmap = context.costmap
    cells = np.where(costmap.costs == LETHAL, OCCUPIED, 0).astype(np.int8)
    window = costmap.window
    grid = OccupancyGrid(cells, window.resolution, Pose2(window.origin_x, window.origin_y))
    return cast_rays(grid, context.base_in_local, ANGLES, VIEW_RANGE).reshape(SECTORS, BEAMS).min(axis=1)
