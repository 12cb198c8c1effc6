"""Observations of the nearest pedestrians and of the map around the robot."""

import math

import gymnasium
import numpy as np
import pytest

from home_service_gym.episode_simulation import moving_discs
from home_service_gym.maps.egocentric_map import FREE_SHADE, OCCUPIED_SHADE, SIDE, UNKNOWN, EgocentricMap
from home_service_gym.people_and_map import NOBODY, nearest_people
from planar import Pose2, SettingsError, grid_from_picture


def test_the_nearest_people_come_first_and_are_in_the_robots_frame():
    people = np.array([[1.0, 5.0, 0.0, 0.0, 0.2], [1.0, 3.0, 0.5, 0.0, 0.2]])
    rows = nearest_people(people, Pose2(1.0, 1.0, math.pi / 2.0), 3)
    assert rows == pytest.approx(np.array([[2.0, 0.0, 0.0, -0.5], [4.0, 0.0, 0.0, 0.0], NOBODY]), abs=1e-6)


def test_only_the_requested_number_of_people_is_observed():
    crowd = np.column_stack([np.arange(9.0), np.zeros((9, 4))])
    assert nearest_people(crowd, Pose2(8.0, 0.0, math.pi), 2)[:, 0] == pytest.approx([0.0, 1.0])


def test_the_egocentric_map_turns_with_the_robot():
    grid = grid_from_picture("#....\n.....\n.....")
    corner = grid.points_of(np.array([[2, 0]]))[0]
    for yaw in (0.0, math.pi / 2.0):
        ahead = Pose2(*corner.tolist(), yaw) @ Pose2(-1.0, 0.0, 0.0)
        picture = EgocentricMap(grid).view_from(ahead)
        row, col = np.argwhere(picture == OCCUPIED_SHADE).mean(axis=0)
        assert row == pytest.approx(SIDE / 2, abs=1.0) and col > SIDE / 2
    assert {UNKNOWN, FREE_SHADE, OCCUPIED_SHADE} == set(np.unique(picture).tolist())


def test_people_walk_and_differ_between_seeds():
    env = gymnasium.make("home_service_gym:PointGoal-v0", scenario="home_people", people=4)
    first, _ = env.reset(seed=1, options={"seed": 1})
    other, _ = env.reset(seed=1, options={"seed": 2})
    again, _ = env.reset(seed=1, options={"seed": 1})
    assert (first["people"] == again["people"]).all() and (first["people"] != other["people"]).any()
    for _ in range(50):
        later, _, is_over, *_ = env.step(np.zeros(2, np.float32))
        if is_over:
            break
    assert np.hypot(*later["people"][:, 2:].T).max() > 0.3
    assert (later["people"][:, :2] != again["people"][:, :2]).any()
    env.close()


def test_no_episode_starts_close_to_a_pedestrian():
    env = gymnasium.make("home_service_gym:PointGoal-v0", scenario="home_people", people=1).unwrapped
    nearest = []
    for seed in range(60):
        observation, _ = env.reset(seed=seed, options={"seed": 1})
        nearest.append(np.hypot(*observation["people"][0, :2]))
        assert observation in env.observation_space
    assert min(nearest) > 0.5
    env.close()


def test_moving_bodies_are_found_at_their_start_positions():
    fields = gymnasium.make("home_service_gym:DynaBARN-v0").unwrapped
    fields.reset(seed=1, options={"seed": 1})
    world = fields._simulation.arena.world
    crowd = moving_discs(world)
    assert len(crowd) == len(world.trajectories) > 0
    for disc, trajectory in zip(crowd.tolist(), world.trajectories):
        assert disc[:2] == pytest.approx(trajectory.at(0.0)) and 0.1 < disc[2] < 2.0
    fields.close()


def test_invalid_observation_options_are_refused():
    with pytest.raises(SettingsError, match="people must not be negative"):
        gymnasium.make("home_service_gym:PointGoal-v0", people=-1)
    with pytest.raises(SettingsError, match="has_map: this task already observes a map"):
        gymnasium.make("home_service_gym:Explore-v0", has_map=True)
