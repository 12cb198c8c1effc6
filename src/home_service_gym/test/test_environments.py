"""Every environment satisfies Gymnasium's contract and is deterministic; each task ends as documented."""

import functools
import math
import warnings
from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence

import home_service_gym
from home_service_gym.environments import (
    BarnEnv,
    DynabarnEnv,
    ExploreEnv,
    FollowEnv,
    HomeServiceEnv,
    PointGoalEnv,
)
from home_service_gym.episode_simulation import moving_discs
from home_service_gym.maps.explored_area import ExploredArea
from home_service_gym.task import Overlay
from home_service_gym.tasks.follow import _leader_path
from home_service_gym.top_view import MOVING, TopView
from home_service_gym.turtlebot3_stage import WALKER_KEYFRAMES, TurtleBot3StageEnv
from planar import FREE, OCCUPIED, Pose2, Scan, SettingsError, grid_from_picture

VARIANTS = [
    *((name, {}) for name in home_service_gym.NAMES),
    *(("TurtleBot3Stage-v0", {"stage": stage}) for stage in (2, 3, 4)),
    ("PointGoal-v0", {"scenario": "home_boxes", "lookahead": 0.6}),
    ("PointGoal-v0", {"scenario": "home_people", "people": 3, "has_map": True}),
]
each_variant = pytest.mark.parametrize(("name", "given"), VARIANTS, ids=lambda value: str(value))


@each_variant
def test_it_passes_gymnasiums_checker_without_warnings(name, given):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", ".*render_mode.*|.*different to the unwrapped.*")
        env = gymnasium.make(name, render_mode="rgb_array", **given)
        check_env(env.unwrapped)
    assert env.unwrapped.spec is not None
    env.close()


def episode(env, seed, steps=60):
    observation, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    options = [observation]
    for _ in range(steps):
        observation, reward, terminated, _, info = env.step(env.action_space.sample())
        options += [observation, reward, terminated, info]
        if terminated:
            break
    return options


@each_variant
def test_an_episode_depends_on_its_seed_only(name, given):
    used, fresh = gymnasium.make(name, **given).unwrapped, gymnasium.make(name, **given).unwrapped
    episode(used, seed=5)
    first, other, again = (episode(used, seed) for seed in (3, 4, 3))
    assert data_equivalence(first, again, exact=True)
    assert data_equivalence(first, episode(fresh, 3), exact=True)
    assert not data_equivalence(first[:4], other[:4], exact=True)
    used.close()
    fresh.close()


@pytest.mark.parametrize("name", home_service_gym.NAMES)
def test_rendered_images_change_during_an_episode(name):
    env = gymnasium.make(name, render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    for _ in range(10):
        env.step(
            2 if isinstance(env.action_space, gymnasium.spaces.Discrete) else np.array([0.5, 0.2], np.float32)
        )
    assert first.dtype == np.uint8 and first.ndim == 3
    assert (env.render() != first).any()
    env.close()


def test_moving_cylinders_are_drawn_to_scale():
    env = DynabarnEnv()
    env.reset(seed=1, options={"seed": 1})
    world, picture = env._simulation.arena.world, TopView(env._simulation)
    pixels = moving_discs(world)[:, 2] * picture._scale
    drawn = (picture.draw(env.state, Overlay(trajectories=world.trajectories)) == MOVING).all(axis=2).sum()
    assert drawn == pytest.approx(math.pi * (pixels**2).sum(), rel=0.2)
    env.close()


def test_several_processes_give_the_results_of_one():
    make = functools.partial(gymnasium.make_vec, "home_service_gym:PointGoal-v0", num_envs=2)
    options = []
    for mode in ("sync", "async"):
        envs = make(vectorization_mode=mode)
        envs.action_space.seed(1)
        options.append(
            [envs.reset(seed=[7, 8])[0], *(envs.step(envs.action_space.sample()) for _ in range(20))]
        )
        envs.close()
    assert data_equivalence(*options, exact=True)


def steer(observation):
    """Turns towards the observed goal, then drives there; ignores obstacles."""
    distance, cosine, sine = observation["goal"]
    bearing = np.arctan2(sine, cosine)
    ahead = 0.5 * min(max(float(distance), 0.0), 1.0) if abs(bearing) < 0.2 else 0.0
    return np.array([ahead, np.clip(bearing, -0.5, 0.5)], dtype=np.float32)


def run_episode(env, policy, seed, steps=900, options=None):
    observation, _ = env.reset(seed=seed, options=options)
    rewards = []
    for _ in range(steps):
        observation, reward, terminated, _, info = env.step(policy(observation))
        rewards.append(reward)
        if terminated:
            break
    env.close()
    return sum(rewards), info.get("outcome", "")


def test_a_goal_in_the_same_room_is_reached_and_rewarded():
    outcomes = [run_episode(PointGoalEnv(), steer, seed) for seed in range(8)]
    reached = [total for total, outcome in outcomes if outcome == "success"]
    assert reached and min(reached) > 9.0
    assert any(outcome == "collision" and total < 0.0 for total, outcome in outcomes)


def test_cells_along_a_beam_are_explored_and_those_behind_a_wall_are_not():
    grid = grid_from_picture("..........\n....#.....\n..........\n..........", 0.1)
    angles, ranges = (-0.25, 0.0, 0.25, 1.5), np.array([0.62, 0.62, np.inf, 0.1], dtype=np.float32)
    explored_area, base = ExploredArea(grid), Pose2(0.05, 0.15)
    scan = Scan(0.0, angles[0], 0.25, ranges[:3], 0.0, 3.0)
    new_cells = explored_area.add_scan(base, scan) + explored_area.add_scan(
        base, replace(scan, angle_min=angles[3], ranges=ranges[3:])
    )
    explored = explored_area.explored
    for angle, reach in zip(angles, (7.2, 7.2, 30.0, 2.0)):
        for along in np.arange(0.0, reach, 0.01):
            row, col = math.floor(1.5 + along * math.sin(angle)), math.floor(0.5 + along * math.cos(angle))
            if not (0 <= row < explored.shape[0] and 0 <= col < explored.shape[1]):
                break
            assert explored[row, col]
            if grid.cells[row, col] == OCCUPIED:
                break
    assert explored[2, 4] and not explored[2, 5], "a wall, and the cell behind it"
    assert explored[1, 7] and not explored[1, 9], "a cell beyond where the beam ends"
    count = np.count_nonzero(explored & (grid.cells == FREE))
    assert new_cells == pytest.approx(0.01 * count)
    assert explored_area.share == count / np.count_nonzero(grid.cells == FREE)
    assert explored_area.add_scan(base, scan) == 0.0, "nothing is new"


def goal_on_path(env, goal):
    """A goal observation of a point ahead on the path, or of the goal itself if it is close."""
    traversable_space, pose = env._simulation.traversable_space, env._state.base_in_world
    path_xy = traversable_space.path(traversable_space.distances_to(goal), pose)
    x, y = path_xy[min(5, len(path_xy) - 1)] - (pose.x, pose.y)
    bearing = np.arctan2(y, x) - pose.yaw
    is_close = pose.distance_to(goal) < 0.15
    return {"goal": (0.0 if is_close else 0.6, np.cos(bearing), np.sin(bearing))}


def test_the_errand_waits_in_the_pickup_zone_and_ends_in_the_drop_off_zone():
    env = HomeServiceEnv()
    observation, _ = env.reset(seed=0)
    assert observation["carrying"] == [0]
    pickup, *onwards = [Pose2(2.0, 3.0), Pose2(-0.3, 0.1), Pose2(-1.7, 0.1), Pose2(-2.0, 1.0)]
    carrying, stood, outcome = 0, 0, ""
    for _ in range(1200):
        goal = onwards[0] if carrying else pickup
        observation, reward, terminated, _, info = env.step(steer(goal_on_path(env, goal)))
        base = env._state.base_in_world
        stood += base.distance_to(pickup) < 0.16
        if carrying and len(onwards) > 1 and base.distance_to(goal) < 0.2:
            onwards.pop(0)
        if observation["carrying"][0] > carrying:
            carrying = 1
            assert reward > 9.0 and stood >= 50
            assert observation["goal"][0] == pytest.approx(np.hypot(4.0, 2.0), abs=0.3), "the other zone"
        if terminated:
            outcome = info["outcome"]
            break
    assert (carrying, outcome) == (1, "success"), info
    env.close()


def test_a_leader_is_lost_unless_the_robot_follows():
    assert run_episode(FollowEnv(), lambda _: np.zeros(2, np.float32), 1)[1] == "lost"
    total, outcome = run_episode(
        FollowEnv(),
        lambda observation: steer({"goal": observation["leader"] - (0.9, 0.0, 0.0)}),
        2,
        steps=150,
    )
    assert outcome == "" and total > 2.0


def test_a_leader_continues_from_a_waypoint_one_cell_away():
    class Neighbours:
        waypoints = (0, 1)

        def path_between(self, start, goal):
            return np.array([[start, 0.0], [goal, 0.0]] if start != goal else [[start, 0.0]], dtype=float)

    path_xy = _leader_path(Neighbours(), np.random.default_rng(0))
    assert len(path_xy) > 20 and (np.hypot(*np.diff(path_xy, axis=0).T) == 1.0).all()


def test_the_observed_velocity_of_a_spinning_robot_stays_within_its_space():
    env = DynabarnEnv()
    env.reset(seed=2027)
    env.action_space.seed(2027)
    fastest = 0.0
    for period in range(300):
        if period % 10 == 0:
            action = env.action_space.sample()
        observation, _, is_over, *_ = env.step(action)
        assert observation in env.observation_space
        fastest = max(fastest, abs(env.state.twist.omega))
        if is_over:
            break
    assert fastest > 8.0, "it did not spin"
    env.close()


def test_a_second_turn_in_place_explores_nothing_new():
    env = ExploreEnv()
    observation, _ = env.reset(seed=2)
    assert 0.0 < (observation["map"] > 0).mean() < 0.6
    rewards = [env.step(np.array([0.0, 0.5], np.float32))[1] for _ in range(80)]
    assert sum(rewards[40:]) < 1.0
    env.close()


def test_moving_cylinders_change_the_scan_of_a_standing_robot():
    env = DynabarnEnv()
    first = env.reset(seed=3)[0]["scan"]
    for _ in range(30):
        last = env.step(np.zeros(2, np.float32))[0]["scan"]
    assert np.abs(last - first).max() > 1.0
    env.close()


def test_driving_straight_through_a_field_is_a_collision():
    total, outcome = run_episode(
        BarnEnv(), lambda _: np.array([0.5, 0.0], np.float32), 0, options={"seed": 2}
    )
    assert outcome == "collision" and total < 0.0


def test_a_reached_goal_of_a_stage_is_replaced_by_another():
    env = TurtleBot3StageEnv(1)
    observation, _ = env.reset(seed=0)
    assert observation.shape == (26,) and observation[25] == pytest.approx(0.6, abs=0.05)
    rewards = [env.step(2)[1] for _ in range(20)]
    assert 200.0 in rewards
    assert env.unwrapped._goal.x != 0.6
    env.close()


def test_walkers_of_stage_four_follow_their_keyframes():
    trajectories = {
        trajectory.link: trajectory
        for trajectory in TurtleBot3StageEnv(4)._simulation.arena.world.trajectories
    }
    for name, walk in WALKER_KEYFRAMES.items():
        trajectory = trajectories[f"{name}::link"]
        there = np.array(trajectory.at(walk[2][0])) - trajectory.at(0.0)
        assert there == pytest.approx(walk[2][1:])


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: TurtleBot3StageEnv(5), "stage must be 1, 2, 3 or 4, got 5"),
        (
            lambda: PointGoalEnv(render_mode="ansi"),
            "render_mode must be rgb_array, human or None, got 'ansi'",
        ),
        (lambda: PointGoalEnv("nowhere"), "nowhere.yaml"),
        (lambda: HomeServiceEnv("fields"), "task must be an errand"),
        (lambda: BarnEnv("home_errand"), "task must be reach"),
        (lambda: BarnEnv(folder="/nonexistent"), "no pairs of world_N.world and path_N.npy"),
        (lambda: DynabarnEnv(folder="/nonexistent"), "no files dynabarn_N.yaml"),
    ],
)
def test_invalid_arguments_are_reported(make, complaint):
    with pytest.raises(SettingsError, match=complaint.replace(".", r"\.")):
        make()
