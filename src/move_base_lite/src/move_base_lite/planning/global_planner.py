"""The contract of global planners: a path through a costmap.

Life cycle: a global planner is constructed with its settings, and again whenever they change.
``GlobalPlanner.plan`` may be called at any time, also from positions other than the robot's; calls are
independent of each other.

To add one: a module with settings (a subclass of PlannerSettings), a class and its Plugin, and a line in
``planning/registry.py``. ``test/test_planner.py`` checks every member of the registry.
"""

import inspect
import warnings
from dataclasses import dataclass
from typing import Any, Iterable, Optional, Protocol, Tuple

import numpy as np

from move_base_lite.costmap import CostmapWindow
from move_base_lite.errors import NavigationError, PlanningPluginFailed
from planar.config.parameters import Interval, at_least, check_parameters, parameter
from planar.extensions import MAX_CALL_SECONDS, ExtensionPoint, InvalidAnswer

ORIENTATIONS = (
    "of the poses: 0 none, 1 forward (GlobalPlanner's), 2 interpolated, 3 forward then interpolated, "
    "4 backward, 5 leftward, 6 rightward"
)


@dataclass(frozen=True)
class PlannerSettings:
    """Settings of any global planner; base class of their settings."""

    allow_unknown: bool = parameter(True, "plans may cross unknown cells")
    default_tolerance: float = parameter(
        0.0, "distance from a blocked goal within which the nearest free cell replaces it", "m", at_least(0.0)
    )
    orientation_mode: int = parameter(0, ORIENTATIONS, bounds=Interval(0, 6, "0 to 6"))
    visualize_potential: bool = parameter(
        False,
        "publish the potential of each plan on the topic potential if it has subscribers; "
        "GlobalPlanner: publish_potential, true",
    )
    publish_scale: int = parameter(
        100, "maximum value of GlobalPlanner's potential", bounds=Interval(1, 127, "1 to 127")
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True, eq=False)
class Potential:
    """The potential of a plan.

    Attributes:
        values: (rows, cols) cost from the robot, float32, inf where the wavefront did not arrive.
        window: Position and resolution of the grid.
        at_goal: Value at the goal.
    """

    values: np.ndarray
    window: CostmapWindow
    at_goal: float


@dataclass(frozen=True, eq=False)
class PlanRequest:
    """What a global planner is asked for.

    Attributes:
        costs: (rows, cols), uint8, values as in ``costmap/costs.py``; read-only.
        window: Position and resolution of the grid.
        start_xy: Start in the window's frame [m]; the nearest free cell within 0.5 m may replace it.
        goal_xy: Goal in the window's frame [m].
        tolerance: Distance from a blocked goal within which the nearest free cell replaces it [m]; the
            settings' ``default_tolerance`` if that is larger.
    """

    costs: np.ndarray
    window: CostmapWindow
    start_xy: Tuple[float, float]
    goal_xy: Tuple[float, float]
    tolerance: float = 0.0


class GlobalPlanner(Protocol):
    """Plans paths; constructed as ``make(settings)``. The costmap is an argument of each call.

    Attributes:
        potential: Potential of the latest call, with or without a path, if the planner computes one and
            ``visualize_potential`` is set; else None.
    """

    potential: Optional[Potential]

    def __init__(self, settings: Any): ...

    def plan(self, request: PlanRequest) -> np.ndarray:
        """Plan a path that enters no cell with a cost of INSCRIBED or more, except to leave an obstacle.

        Args:
            request: Costmap, start and goal.

        Returns:
            Path (N, 2), N > 1, from start to goal in small steps [m].

        Raises:
            OutOfMap: Start or goal is outside of the window.
            StartBlocked: The start is blocked.
            GoalBlocked: The goal is blocked.
            NoPath: No path connects start and goal. The texts of all four state the position.
        """
        ...


def _checked(path_xy: np.ndarray, *given: Any) -> np.ndarray:
    """Refuse an answer that the robot cannot follow."""
    path_xy = np.asarray(path_xy, float)
    if not (path_xy.ndim == 2 and path_xy.shape[1:] == (2,) and len(path_xy) > 1):
        raise InvalidAnswer(f"gave a path of the shape {path_xy.shape}, not (N, 2) with N > 1")
    if not np.isfinite(path_xy).all():
        raise InvalidAnswer("gave a path that is not finite")
    return path_xy


def _requirements(found: Any) -> Iterable[str]:
    """Let planners from before there were requests take one; they have five arguments."""
    plan = getattr(found, "plan", None)
    try:
        inspect.signature(plan).bind("self", "costs", "window", "start_xy", "goal_xy")  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return ()
    warnings.warn(
        f"{found.__module__}.{found.__name__}.plan(costs, window, ...) is deprecated; take a PlanRequest",
        DeprecationWarning,
        stacklevel=2,
    )
    found.plan = lambda self, request: plan(self, *vars(request).values())  # type: ignore[misc]
    return ()


CONTRACT: ExtensionPoint[GlobalPlanner] = ExtensionPoint(
    "global planner",
    GlobalPlanner,
    "move_base_lite.global_planners",
    PlanningPluginFailed,
    passes=(NavigationError,),
    answers={"plan": _checked},
    max_seconds=MAX_CALL_SECONDS,
    is_lazy=True,
    settings=PlannerSettings,
    requirements=_requirements,
    parameter="base_global_planner",
)
