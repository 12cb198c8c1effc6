"""Rollouts of MPPI."""

from dataclasses import replace

import numpy as np
import pytest

from move_base_lite.check import maps
from move_base_lite.control import Plan
from move_base_lite.control.mppi.rollout import CostWeights, MotionLimits, costs_of, drive, is_unobstructed
from move_base_lite.control.mppi.scene import scene_of
from planar import Pose2, Twist2

STEPS = 20


def test_parallel_rollouts_cost_the_same_as_single_ones():
    problem, start = problem_beside_a_wall_and_a_person()
    rng = np.random.default_rng(4)
    noise, others = (rng.normal(0.0, (0.3, 0.8), (count, STEPS, 2)) for count in (300, 40))
    mean = np.tile((0.2, 0.1), (STEPS, 1))
    costs = costs_of((noise, mean, others), start, problem)
    poses, speeds = np.empty((STEPS + 1, 3)), np.empty((STEPS, 2))
    alone, ended_early = [], 0
    for controls in (*(noise + mean), *others):
        alone.append(drive(controls, start, problem, poses, speeds))
        ended_early += np.isfinite(alone[-1]) and (poses[-1] == poses[-2]).all()
    assert 0 < ended_early < 340 and 0 < np.isinf(costs).sum() < 340
    assert (costs == alone).all()


@pytest.mark.parametrize(
    "pose, people, expected",
    [
        pytest.param(Pose2(1.5, 1.5, 0.0), [], True, id="open"),
        pytest.param(Pose2(1.5, 1.5, 0.0), [(3.5, 3.5, 0.0, 0.0, 0.25)], False, id="person"),
        pytest.param(Pose2(0.5 + maps.RADIUS + 0.1, 1.5, 1.57), [], False, id="beside a wall"),
        pytest.param(Pose2(1.2, 1.5, 3.14), [], False, id="towards a wall"),
    ],
)
def test_unobstructed_controls_stay_away_from_obstacles_and_people(pose, people, expected):
    problem, start = problem_at(pose, np.array(people).reshape(-1, 5))
    assert is_unobstructed(np.tile((0.3, 0.0), (STEPS, 1)), start, problem) == expected


def problem_beside_a_wall_and_a_person():
    return problem_at(
        Pose2(0.5 + maps.RADIUS + 0.1, 1.3, 2.0), people=np.array([(2.0, 1.9, -0.3, -0.1, 0.25)])
    )


def problem_at(pose, people):
    room, twist = maps.check_map("open"), Twist2(0.3, 0.0)
    context = replace(maps.context_of(room.costmap, pose, twist), dynamic_obstacles=people)
    plan = Plan(np.linspace((pose.x, pose.y), room.goal_xy, 20), 4.0)
    scene = scene_of(context, plan, use_global_costmap=False)
    limits = MotionLimits(maps.PERIOD, -0.3, 0.5, 1.5, 0.5, 2.0, 0.25, 0.3)
    weights = CostWeights(0.15, 2.0, 0.02, 1.0, 0.2, 0.5, 10.0, 0.15)
    return (scene, limits, weights), np.array([*pose.as_array(), twist.v, twist.omega])


@pytest.mark.parametrize(
    "people, is_known",
    [
        pytest.param(np.zeros((0, 5)), False, id="alone"),
        pytest.param(np.array([(0.6, 3.2, 0.0, 0.0, 0.25)]), True, id="person"),
    ],
)
def test_places_that_seem_unreachable_are_no_worse_than_a_contact_among_people(people, is_known):
    (scene, limits, weights), start = problem_at(Pose2(2.0, 1.75, 0.0), people)
    to_go = np.array(scene.to_go)
    to_go[:, scene_column(scene, 2.1) :] = np.inf
    problem = scene._replace(to_go=to_go), limits, weights
    poses, speeds = np.empty((STEPS + 1, 3)), np.empty((STEPS, 2))
    cost = drive(np.tile((0.5, 0.0), (STEPS, 1)), start, problem, poses, speeds)
    assert poses[-1, 0] > 2.3
    assert (cost < 20.0) == is_known


def scene_column(scene, x):
    return int((x - scene.origin_x) * scene.cells_per_metre)
