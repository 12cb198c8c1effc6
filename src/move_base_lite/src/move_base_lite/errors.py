# ruff: noqa: N818  -- the names are the reasons
"""Errors of navigation: the class is the reason, the text is for people."""

from typing import Optional

from move_base_lite.trajectory_samples import TrajectorySamples
from planar import PlanarError
from planar.deprecation import renamed_fields


class NavigationError(PlanarError):
    """Base class: something keeps the robot from its goal.

    Attributes:
        code: The reason, for programs.
        outcome: Outcome code of move_base_flex (mbf_msgs/MoveBaseResult).
    """

    code = "FAILURE"
    outcome = 10


class PlanningError(NavigationError):
    """There is no plan to the goal."""

    code = "PLANNING_FAILED"
    outcome = 50


class OutOfMap(PlanningError):
    """The start or the goal is outside the costmap."""

    code = "OUT_OF_MAP"


class StartBlocked(PlanningError):
    """The robot is in an obstacle and there is no free space near it."""

    code = "START_BLOCKED"
    outcome = 14


class GoalBlocked(PlanningError):
    """The goal, and every point within its tolerance, is in or too close to an obstacle."""

    code = "GOAL_BLOCKED"
    outcome = 15


class NoPath(PlanningError):
    """Start and goal are free, but no path connects them."""

    code = "NO_PATH"


@renamed_fields(exploration="trajectory_samples")
class ControlError(NavigationError):
    """No safe velocity follows the plan.

    Attributes:
        trajectory_samples: Samples that the local planner evaluated, if it offers them.
    """

    code = "NO_VALID_CONTROL"
    outcome = 100

    def __init__(self, text: str, trajectory_samples: Optional[TrajectorySamples] = None):
        """Create the error.

        Args:
            text: Reason, for people.
            trajectory_samples: Samples that the local planner evaluated.
        """
        super().__init__(text)
        self.trajectory_samples = trajectory_samples


class PluginFailed(NavigationError):
    """A user-defined plugin raised or returned an invalid value; the text begins with its name."""

    code = "PLUGIN_FAILED"
    outcome = 17


class PlanningPluginFailed(PluginFailed, PlanningError):
    """A user-defined global planner failed."""


class ControlPluginFailed(PluginFailed, ControlError):
    """A user-defined local planner failed."""


class Oscillation(NavigationError):
    """The robot makes no progress for ~oscillation_timeout."""

    code = "OSCILLATION"
    outcome = 13


class SensorStale(NavigationError):
    """A sensor sends no data, so the robot must not move."""

    code = "SENSOR_STALE"


class RobotLost(NavigationError):
    """The pose of the robot is unknown."""

    code = "TF_ERROR"
    outcome = 16
