"""The contract of global planners: a way through a costmap.

Life cycle. A global planner is made with its settings, and anew whenever they change. It may be asked for a
:meth:`~GlobalPlanner.plan` at any time, also between places where the robot is not; each question stands for
itself.

To add one: a file with settings (a subclass of PlannerSettings), a class and its Plugin, and a line in
``planning/registry.py``. ``test/test_planner.py`` holds it to what is said here.
"""

from dataclasses import dataclass
from typing import Any, Optional, Protocol, Tuple

import numpy as np

from move_base_lite.costmap import CostmapWindow
from planar.config.parameters import Interval, at_least, check_parameters, parameter

ORIENTATIONS = (
    "of the poses: 0 none, 1 forward (GlobalPlanner's), 2 interpolated, 3 forward then interpolated, "
    "4 backward, 5 leftward, 6 rightward"
)


@dataclass(frozen=True)
class PlannerSettings:
    """What every global planner can be told."""

    allow_unknown: bool = parameter(True, "plans may cross cells that nothing is known of")
    default_tolerance: float = parameter(
        0.0, "from a blocked goal, within which the nearest free place will do", "m", at_least(0.0)
    )
    orientation_mode: int = parameter(0, ORIENTATIONS, bounds=Interval(0, 6, "0 to 6"))
    visualize_potential: bool = parameter(
        False,
        "whether each plan's wave is on the topic potential, while somebody listens; "
        "GlobalPlanner: publish_potential, true",
    )
    publish_scale: int = parameter(
        100, "the highest value of GlobalPlanner's potential", bounds=Interval(1, 127, "1 to 127")
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True, eq=False)
class Potential:
    """The wave of a plan: cost from the robot, float32 (rows, cols), inf where it has not come to.

    ``at_goal``: its value there.
    """

    values: np.ndarray
    window: CostmapWindow
    at_goal: float


class GlobalPlanner(Protocol):
    """Made by ``make(settings)``; holds no costmap of its own.

    ``potential``: the wave of the newest plan, found or not, if it has one and the settings ask for it.
    """

    potential: Optional[Potential]

    def __init__(self, settings: Any): ...

    def plan(
        self,
        costs: np.ndarray,
        window: CostmapWindow,
        start_xy: Tuple[float, float],
        goal_xy: Tuple[float, float],
        tolerance: float = 0.0,
    ) -> np.ndarray:
        """Path (N, 2), N > 1, metres in the window's frame, from start to goal or near it, in small steps.

        ``costs``: uint8 (rows, cols) with the meaning of ``costmap/costs.py``, not to be changed; the path
        crosses no cell from INSCRIBED on, but to get out of one. A goal that cannot be stood on gives way to
        the nearest free place within ``tolerance`` metres (or the settings' default if that is larger); a
        start, to one within half a metre.
        Raises OutOfMap, StartBlocked, GoalBlocked or NoPath, whose texts name the place.
        """
        ...
