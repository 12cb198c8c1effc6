"""Evasion of dynamic obstacles on a collision course."""

from dataclasses import replace

import numpy as np
import pytest

from move_base_lite.check import maps
from move_base_lite.control import Plan
from move_base_lite.control.mppi import MPPI
from move_base_lite.control.mppi.samples import evasive_controls
from move_base_lite.errors import ControlError
from planar import Pose2, Twist2

HERE_XY = np.array([3.0, 1.75])
# The obstacle's radius [m], gap to the robot [m] and speed [m/s].
OBSTACLE_RADIUS, NEAR, SPEED = 0.25, 0.04, 0.3


def command(bearing):
    """Command to a standing robot while an obstacle approaches from ``bearing`` [rad]."""
    open_room = maps.check_map("open")
    aside = np.array([np.cos(bearing), np.sin(bearing)])
    obstacle_xy, velocity = HERE_XY + (maps.RADIUS + OBSTACLE_RADIUS + NEAR) * aside, -SPEED * aside
    context = replace(
        maps.context_of(open_room.costmap, Pose2(*HERE_XY, 0.0)),
        dynamic_obstacles=np.array([[*obstacle_xy, *velocity, OBSTACLE_RADIUS]]),
    )
    planner = MPPI.make(MPPI.settings(), maps.PERIOD)
    plan = Plan(np.linspace(HERE_XY, open_room.goal_xy, 20), 2.0)
    return planner.follow(context, plan, Twist2(0.5, 1.5)).command


@pytest.mark.parametrize("bearing", [1.6, -1.6, 2.6, 3.1])
def test_a_standing_robot_drives_off_even_if_the_obstacle_first_comes_closer(bearing):
    assert command(bearing).v > 0.1


def test_a_robot_backs_up_from_an_obstacle_ahead():
    assert command(0.0).v < 0.0


@pytest.mark.parametrize("heading", [0.0, 0.4, -0.7, 2.1])
def test_a_crowded_robot_does_not_creep_into_the_wall_behind_it(heading):
    costmap = maps.check_map("open").costmap
    planner = MPPI.make(replace(MPPI.settings(), min_vel_x=-0.15), maps.PERIOD)
    pose, twist = Pose2(0.5 + maps.RADIUS + 0.07, 1.3, heading), Twist2()
    plan = Plan(np.linspace((pose.x, pose.y), (5.0, 1.25), 20), 4.0)
    gap = 0.25
    assert costmap.contacts(pose) == 0
    for _ in range(20):
        gap = max(gap - 0.03, 0.0)
        crowd = [
            (
                pose.x + (maps.RADIUS + OBSTACLE_RADIUS + gap) * c,
                pose.y + (maps.RADIUS + OBSTACLE_RADIUS + gap) * s,
            )
            for c, s in ((1.0, 0.0), (0.5, 0.87), (0.5, -0.87))
        ]
        dynamic_obstacles = np.array(
            [(x, y, 0.6 * (pose.x - x), 0.6 * (pose.y - y), OBSTACLE_RADIUS) for x, y in crowd]
        )
        context = replace(maps.context_of(costmap, pose, twist), dynamic_obstacles=dynamic_obstacles)
        try:
            twist = planner.follow(context, plan, Twist2(0.5, 1.5)).command
        except ControlError:
            twist = Twist2()
        pose = maps.moved(pose, twist)
        assert costmap.contacts(pose) == 0


def test_evasive_controls_have_two_different_arcs_each():
    controls = evasive_controls(MPPI.settings(), 20)
    assert (controls[:, 0] != controls[:, -1]).any(axis=1).all()
    assert len(np.unique(controls[:, [0, -1]].reshape(len(controls), 4), axis=0)) == len(controls) == 15 * 14
