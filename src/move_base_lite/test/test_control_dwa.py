"""The dynamic window approach: velocity samples and critics."""

import numpy as np
import pytest

from move_base_lite.check.maps import PERIOD, check_map, context_of, plan_in
from move_base_lite.control import DwaSettings, Plan, TrajectorySettings
from move_base_lite.control.dwa import DwaPlanner
from move_base_lite.control.dwa.critics import goal_distance, obstacles, path_alignment, path_distance
from move_base_lite.control.dwa.planner import _scene, velocity_samples
from move_base_lite.errors import ControlError
from planar import Pose2, Twist2

LIMITS = Twist2(0.5, 1.0)


@pytest.fixture(scope="module")
def scene():
    """An open room with a plan from its left to its right end."""
    room = check_map("open")
    context = context_of(room.costmap, Pose2(*room.start_xy, 0.0))
    return _scene(context, np.array([room.start_xy, room.goal_xy]), forward_distance=0.3)


def ending_at(*poses):
    return np.array(poses, dtype=float)


def test_a_robot_at_rest_samples_reachable_velocities_that_move_it():
    settings = DwaSettings(vx_samples=5, vth_samples=7)
    velocities = velocity_samples(settings, Twist2(), LIMITS, PERIOD)
    assert len(velocities) and (velocities[:, 0] >= settings.min_vel_trans - 1e-4).all()
    assert velocities[:, 0].max() == pytest.approx(settings.acc_lim_x * PERIOD)
    assert np.abs(velocities[:, 1]).max() == pytest.approx(settings.acc_lim_theta * PERIOD)


def test_a_limit_below_the_minimum_speed_leaves_no_velocity():
    room = check_map("open")
    planner = DwaPlanner(DwaSettings(), PERIOD)
    context = context_of(room.costmap, Pose2(*room.start_xy, 0.0))
    with pytest.raises(ControlError) as caught:
        planner.follow(context, Plan(plan_in(room), 4.5), Twist2(0.05, 1.0))
    assert len(caught.value.trajectory_samples.trajectory_points()) == 0


def test_distance_critics_count_cells_to_the_plan_and_to_its_end(scene):
    near, far = ending_at((2.0, 1.25, 0.0)), ending_at((2.0, 1.75, 0.0))
    assert goal_distance(ending_at((5.25, 1.25, 0.0)), scene) < goal_distance(near, scene)
    assert goal_distance(near, scene) == pytest.approx(65.0, abs=1.0)
    assert goal_distance(near, scene) < goal_distance(far, scene)
    start = ending_at((0.75, 1.25, 0.0))
    assert path_distance(start, scene) < path_distance(ending_at((0.75, 1.75, 0.0)), scene)


def test_the_alignment_critic_scores_the_forward_point(scene):
    along, across = ending_at((0.45, 1.25, 0.0)), ending_at((0.75, 1.25, 1.57))
    assert path_alignment(along, scene) < path_alignment(across, scene)


def test_the_obstacle_critic_forbids_collisions_but_allows_to_leave_one(scene):
    into_wall = ending_at((0.9, 1.25, 0.0), (0.6, 1.25, 0.0))
    assert obstacles(into_wall, scene, 0) == np.inf
    assert obstacles(ending_at((2.0, 1.25, 0.0)), scene, 0) < 253.0
    assert obstacles(into_wall[::-1].copy(), scene, 99) == 253.0


def test_parameters_of_trajectory_planner_make_dwa_settings():
    settings = TrajectorySettings(max_vel_x=0.3, min_vel_theta=0.2)
    assert (settings.max_vel_trans, settings.heading_lookahead, settings.sim_time) == (0.3, 0.4, 1.0)
