"""Small maps, drawn as pictures, on which plugins are checked."""

import math
from dataclasses import dataclass
from typing import Any, List, Tuple

import numpy as np

from move_base_lite.control import ControlContext, Controller
from move_base_lite.costmap import CostmapSettings, LayeredCostmap, named_layers
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings
from move_base_lite.costmap.layers.static import StaticSettings
from move_base_lite.dynamic_obstacles import NO_DYNAMIC_OBSTACLES
from move_base_lite.planning import Navfn, NavfnSettings, PlanRequest
from planar import Pose2, Twist2, grid_from_picture
from planar.extensions import Plugin
from planar.extensions.check import CheckFailed

PERIOD = 0.1
RADIUS = 0.2
# Size of a picture's character and of a grid cell [m]; the robot drives from S to G.
CELL, RESOLUTION = 0.5, 0.05
PICTURES = {
    "open": """
############
#..........#
#S........G#
#..........#
############""",
    "corner": """
#########
#S......#
#.......#
#####...#
#####...#
#####.G.#
#########""",
    "door": """
############
#....#.....#
#....#.....#
#S........G#
#....#.....#
#....#.....#
############""",
    "post": """
############
#..........#
#..........#
#S...#....G#
#..........#
#..........#
############""",
}
UNLIMITED = Twist2(math.inf, math.inf)


@dataclass(frozen=True)
class CheckMap:
    """A costmap with start and goal.

    Attributes:
        costmap: The costmap.
        start_xy: Start in the costmap's frame [m].
        goal_xy: Goal in the costmap's frame [m].
    """

    costmap: LayeredCostmap
    start_xy: Tuple[float, float]
    goal_xy: Tuple[float, float]

    @property
    def plan_request(self) -> PlanRequest:
        """Request of a path from start to goal."""
        return PlanRequest(self.costmap.costs, self.costmap.window, self.start_xy, self.goal_xy)


def check_map(name: str) -> CheckMap:
    """Return the map of a name.

    Args:
        name: Key of PICTURES.

    Returns:
        Costmap with cells of RESOLUTION, start and goal.
    """
    picture = PICTURES[name].strip()
    without_marks = picture.replace("S", ".").replace("G", ".")
    grid = grid_from_picture(without_marks, RESOLUTION, scale=round(CELL / RESOLUTION))
    settings = CostmapSettings(
        robot_radius=RADIUS,
        layers=named_layers(
            static=StaticSettings(),
            obstacles=ObstacleSettings(),
            inflation=InflationSettings(inflation_radius=0.5, cost_scaling_factor=5.0),
        ),
    )
    return CheckMap(LayeredCostmap(settings, grid), _centre_of("S", picture), _centre_of("G", picture))


def _centre_of(mark: str, picture: str) -> Tuple[float, float]:
    for number, line in enumerate(reversed(picture.splitlines())):
        if mark in line:
            return (line.index(mark) + 0.5) * CELL, (number + 0.5) * CELL
    raise ValueError(f"a picture without {mark}")


def context_of(costmap: LayeredCostmap, pose: Pose2, twist: Twist2 = Twist2()) -> ControlContext:
    """Create a context without dynamic obstacles, in which map and odom frame coincide.

    Args:
        costmap: Local and global costmap.
        pose: Robot pose in the costmap's frame.
        twist: Velocity of the robot.
    """
    return ControlContext(pose, pose, twist, costmap, NO_DYNAMIC_OBSTACLES, costmap)


def plan_in(room: CheckMap) -> np.ndarray:
    """Plan navfn's path (N, 2) from start to goal [m]."""
    return Navfn(NavfnSettings()).plan(room.plan_request)


def drive(plugin: Plugin[Any], room: CheckMap, seconds: float = 40.0) -> List[Pose2]:
    """Drive to the goal with a local planner whose commands take effect without delay.

    Args:
        plugin: The local planner.
        room: The map.
        seconds: Time limit [s].

    Returns:
        The robot's pose in each period.

    Raises:
        CheckFailed: The goal was not reached in time.
    """
    settings = plugin.settings()
    controller = Controller(settings, PERIOD, plugin.make(settings, PERIOD))
    controller.set_plan(plan_in(room), Pose2(*room.goal_xy, 0.0))
    pose, twist, poses = Pose2(*room.start_xy, 0.0), Twist2(), []
    for _ in range(round(seconds / PERIOD)):
        poses.append(pose)
        if controller.is_goal_reached(pose, twist):
            return poses
        twist = controller.control(context_of(room.costmap, pose, twist), UNLIMITED).command
        pose = moved(pose, twist)
    raise CheckFailed(
        f"the goal was not reached within {seconds:g} s; the robot is at ({pose.x:.2f}, {pose.y:.2f})"
    )


def moved(pose: Pose2, twist: Twist2) -> Pose2:
    """Compute the pose after one period at a velocity."""
    half_turn, distance = 0.5 * twist.omega * PERIOD, twist.v * PERIOD
    return pose @ Pose2(distance * math.cos(half_turn), distance * math.sin(half_turn), 2.0 * half_turn)
