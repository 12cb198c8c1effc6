"""Whether a contact could have been avoided."""

import numpy as np
import pytest

from laboratory.results.avoidance import RobotLimits, TrueObstacles, can_avoid, state_before
from laboratory.worlds.solids import FLOOR, post, wall
from planar import Pose2
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import World

LIMITS = RobotLimits(
    min_v=-0.5,
    max_v=2.0,
    max_omega=2.0,
    acceleration=2.5,
    turn_acceleration=6.0,
    half_length=0.21,
    half_width=0.165,
)
STANDING, DRIVING = (0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 2.0, 0.0)


def obstacles(*bodies, start_x=0.0, speed=0.0):
    """Bodies, and a cylinder that comes along the x axis if it has a speed."""
    if not speed:
        return TrueObstacles.of_world(World("still", (FLOOR, *bodies)))
    cylinder = post("comes", Pose2(start_x, 0.0), 0.5, 1.0, is_kinematic=True)
    points_xy = np.array([[start_x, 0.0], [start_x + 10.0 * speed, 0.0]])
    trajectory = ScriptedTrajectory(cylinder.name, np.array([0.0, 10.0]), points_xy)
    return TrueObstacles.of_world(World("moving", (FLOOR, *bodies, cylinder), trajectories=(trajectory,)))


@pytest.mark.parametrize(("distance", "expected"), [(0.9, True), (0.5, False)])
def test_a_robot_avoids_a_wall_if_its_braking_distance_is_short_enough(distance, expected):
    # It brakes from 2 m/s within 0.8 m.
    ahead = wall("ahead", distance + LIMITS.half_length + 0.1, 0.0, 0.2, 20.0)
    assert can_avoid(obstacles(ahead), LIMITS, DRIVING, 0.0, 2.0) is expected


@pytest.mark.parametrize(("speed", "start_x", "expected"), [(1.0, -1.5, True), (4.0, -2.0, False)])
def test_a_robot_evades_a_slow_cylinder_but_not_a_fast_one(speed, start_x, expected):
    comes = obstacles(start_x=start_x, speed=speed)
    assert can_avoid(comes, LIMITS, STANDING, 0.0, 2.0) is expected


def test_a_robot_between_walls_cannot_evade():
    walls = [wall(f"side_{y}", 0.0, y, 20.0, 0.2) for y in (-0.6, 0.6)]
    end = wall("end", 1.0, 0.0, 0.2, 2.0)
    assert not can_avoid(obstacles(*walls, end, start_x=-2.0, speed=1.5), LIMITS, STANDING, 0.0, 2.0)
    assert can_avoid(obstacles(*walls, start_x=-2.0, speed=1.5), LIMITS, STANDING, 0.0, 2.0)


def test_the_cylinder_is_where_it_is_at_the_time_of_the_state():
    passed = obstacles(start_x=-10.0, speed=2.0)
    assert not can_avoid(passed, LIMITS, DRIVING, 4.7, 1.0)
    assert can_avoid(passed, LIMITS, DRIVING, 8.0, 1.0)


def test_the_state_before_the_end_of_a_track_has_its_speeds():
    stamps = np.arange(0.0, 2.01, 0.1)
    track = np.column_stack((stamps, np.sin(stamps), 1.0 - np.cos(stamps), stamps))  # unit circle at 1 m/s
    state, stamp = state_before(track, 1.0)
    assert stamp == pytest.approx(1.0)
    assert state == pytest.approx([np.sin(1.0), 1.0 - np.cos(1.0), 1.0, 1.0, 1.0], rel=2e-3)
