# ruff: noqa: N818  -- the names are the reasons
"""Why the robot cannot go: one class per reason, the text for people."""

from typing import TYPE_CHECKING, Optional

from planar import PlanarError
from planar.deprecation import renamed_fields

if TYPE_CHECKING:
    from move_base_lite.control.local_planner import TrajectorySamples


class NavigationError(PlanarError):
    """Something keeps the robot from its goal; ``code`` names the reason for programs, ``outcome`` is the
    number that move_base_flex has for it (mbf_msgs/MoveBaseResult)."""

    code = "FAILURE"
    outcome = 10


class PlanningError(NavigationError):
    """There is no plan to the goal."""

    code = "PLANNING_FAILED"
    outcome = 50


class OutOfMap(PlanningError):
    """The start or the goal lies outside the costmap."""

    code = "OUT_OF_MAP"


class StartBlocked(PlanningError):
    """The robot stands in an obstacle and there is no free space near it."""

    code = "START_BLOCKED"
    outcome = 14


class GoalBlocked(PlanningError):
    """The goal lies in or too close to an obstacle, and so does all that its tolerance allows."""

    code = "GOAL_BLOCKED"
    outcome = 15


class NoPath(PlanningError):
    """Start and goal are free, but nothing connects them."""

    code = "NO_PATH"


@renamed_fields(exploration="trajectory_samples")
class ControlError(NavigationError):
    """No safe velocity follows the plan.

    Attributes:
        trajectory_samples: The trajectories that the local planner evaluated, if it can show them.
    """

    code = "NO_VALID_CONTROL"
    outcome = 100

    def __init__(self, text: str, trajectory_samples: "Optional[TrajectorySamples]" = None):
        super().__init__(text)
        self.trajectory_samples = trajectory_samples


class PluginFailed(NavigationError):
    """A class of other people raised, or answered with what cannot be used; the text begins with its name."""

    code = "PLUGIN_FAILED"
    outcome = 17


class PlanningPluginFailed(PluginFailed, PlanningError):
    """It was to make a plan."""


class ControlPluginFailed(PluginFailed, ControlError):
    """It was to find a velocity."""


class Oscillation(NavigationError):
    """The robot moves, but gets nowhere."""

    code = "OSCILLATION"
    outcome = 13


class SensorStale(NavigationError):
    """The scans have stopped, so the robot must not move."""

    code = "SENSOR_STALE"


class RobotLost(NavigationError):
    """It is not known where the robot is."""

    code = "TF_ERROR"
    outcome = 16
