"""Tiny maps drawn as pictures, in which a plugin has to show what it can do."""

import math
from dataclasses import dataclass, replace
from typing import Any, List, Tuple

import numpy as np

from move_base_lite.control import ControlContext, Controller
from move_base_lite.costmap import CostmapSettings, LayeredCostmap
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.static import StaticSettings
from move_base_lite.dynamic_obstacles import NO_DYNAMIC_OBSTACLES
from move_base_lite.planning import Navfn, NavfnSettings
from move_base_lite.plugin import Plugin
from planar import Pose2, Twist2, grid_from_picture
from planar.contract_check import CheckFailed

PERIOD = 0.1
RADIUS = 0.2
# Metres across a character of a picture, in which the robot drives from S to G.
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
ANYWHERE = Twist2(math.inf, math.inf)


@dataclass(frozen=True)
class CheckMap:
    """A costmap with a start and a goal, metres in its frame."""

    costmap: LayeredCostmap
    start_xy: Tuple[float, float]
    goal_xy: Tuple[float, float]


def check_map(name: str) -> CheckMap:
    """The picture of that name in cells of 0.05 m."""
    picture = PICTURES[name].strip()
    coarse = grid_from_picture(picture.replace("S", ".").replace("G", "."), CELL)
    times = round(CELL / RESOLUTION)
    cells = np.kron(coarse.cells, np.ones((times, times), np.int8))
    grid = replace(coarse, cells=cells, resolution=RESOLUTION)
    settings = CostmapSettings(
        static=StaticSettings(),
        robot_radius=RADIUS,
        inflation=InflationSettings(inflation_radius=0.5, cost_scaling_factor=5.0),
    )
    return CheckMap(LayeredCostmap(settings, grid), _centre_of("S", picture), _centre_of("G", picture))


def _centre_of(mark: str, picture: str) -> Tuple[float, float]:
    for number, line in enumerate(reversed(picture.splitlines())):
        if mark in line:
            return (line.index(mark) + 0.5) * CELL, (number + 0.5) * CELL
    raise ValueError(f"a picture without {mark}")


def context_of(costmap: LayeredCostmap, pose: Pose2, twist: Twist2 = Twist2()) -> ControlContext:
    return ControlContext(pose, pose, twist, costmap, NO_DYNAMIC_OBSTACLES, costmap)


def plan_in(room: CheckMap) -> np.ndarray:
    """Navfn's path (N, 2) from start to goal."""
    costs, window = room.costmap.costs, room.costmap.window
    return Navfn(NavfnSettings()).plan(costs, window, room.start_xy, room.goal_xy)


def drive(plugin: Plugin[Any], room: CheckMap, seconds: float = 40.0) -> List[Pose2]:
    """The poses of a robot that does at once what a local planner says, until it stands at the goal."""
    settings = plugin.settings()
    controller = Controller(settings, PERIOD, plugin.make(settings, PERIOD))
    controller.set_plan(plan_in(room), Pose2(*room.goal_xy, 0.0))
    pose, twist, poses = Pose2(*room.start_xy, 0.0), Twist2(), []
    for _ in range(round(seconds / PERIOD)):
        poses.append(pose)
        if controller.is_goal_reached(pose, twist):
            return poses
        twist = controller.control(context_of(room.costmap, pose, twist), ANYWHERE).command
        pose = moved(pose, twist)
    raise CheckFailed(f"not at the goal after {seconds:g} s, but at ({pose.x:.2f}, {pose.y:.2f})")


def moved(pose: Pose2, twist: Twist2) -> Pose2:
    """Where a velocity has led after a period."""
    half_turn, way = 0.5 * twist.omega * PERIOD, twist.v * PERIOD
    return pose @ Pose2(way * math.cos(half_turn), way * math.sin(half_turn), 2.0 * half_turn)
