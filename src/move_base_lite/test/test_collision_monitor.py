"""The collision monitor: no command leads to a collision, and safe commands pass."""

import math
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
import yaml

from move_base_lite.collision_monitor import (
    CLEAR,
    SLOWED,
    STOPPED,
    CollisionMonitor,
    LimitedCommand,
    MonitorSettings,
)
from planar import Pose2, SettingsError, Twist2

SETTINGS = MonitorSettings(robot_radius=0.2, stop_distance=0.05, time_to_collision=1.0)
NOTHING = np.empty((0, 2))


def wall(x):
    """Points of a wall across the path, ``x`` metres ahead."""
    return np.column_stack((np.full(41, x), np.linspace(-1.0, 1.0, 41)))


def limit_command(command, points_xy, settings=SETTINGS):
    return CollisionMonitor(settings).limit_command(command, points_xy)


def test_a_command_passes_without_near_obstacles():
    for points_xy in (NOTHING, wall(2.0)):
        command = Twist2(0.5, 0.3)
        assert limit_command(command, points_xy) == LimitedCommand(command, CLEAR)


def test_a_command_towards_a_wall_is_slowed_and_stopped_at_the_distance():
    limited = limit_command(Twist2(0.5), wall(0.55))
    assert limited.reason == SLOWED
    # 0.3 m remain at 0.5 m/s, and the time to collision is 1 s.
    assert limited.command.v == pytest.approx(0.3, abs=0.03)
    assert limit_command(Twist2(0.5), wall(0.26)) == LimitedCommand(Twist2(), STOPPED)


def test_an_arc_keeps_its_shape_when_it_is_slowed():
    limited = limit_command(Twist2(0.6, 0.3), wall(0.6))
    assert limited.reason == SLOWED
    assert limited.command.omega / limited.command.v == pytest.approx(0.5)


def test_a_robot_in_contact_may_only_move_away():
    touching = wall(0.2)
    assert limit_command(Twist2(-0.2), touching).reason == CLEAR
    assert limit_command(Twist2(0.2), touching).reason == STOPPED
    assert limit_command(Twist2(0.0, 0.5), touching).reason == CLEAR


def test_a_long_robot_does_not_turn_into_a_wall_beside_it():
    box = ((-0.4, -0.15), (0.4, -0.15), (0.4, 0.15), (-0.4, 0.15))
    settings = MonitorSettings(footprint=box, stop_distance=0.02)
    beside = np.column_stack((np.linspace(-1.0, 1.0, 41), np.full(41, 0.2)))
    assert limit_command(Twist2(0.5), beside, settings).reason == CLEAR
    assert limit_command(Twist2(0.0, 1.0), beside, settings).reason != CLEAR


def test_points_well_inside_the_outline_belong_to_the_robot():
    assert limit_command(Twist2(0.5), np.array([[0.1, 0.0]])).reason == CLEAR


@pytest.mark.parametrize("seed", range(20))
def test_random_commands_never_lead_to_a_collision(seed):
    """Random commands among random posts; the robot follows the limited commands exactly at 10 Hz."""
    rng = np.random.default_rng(seed)
    posts_xy = rng.uniform(-3.0, 3.0, (40, 2))
    posts_xy = posts_xy[np.hypot(*posts_xy.T) > 0.4]
    monitor, base, moved = CollisionMonitor(SETTINGS), Pose2(), 0.0
    command = Twist2()
    for tick in range(600):
        if tick % 10 == 0:
            command = Twist2(rng.uniform(-0.7, 0.7), rng.uniform(-2.0, 2.0))
        passed = monitor.limit_command(command, base.inverse().transform_points(posts_xy)).command
        angle = 0.1 * passed.omega
        base = base @ Pose2(0.1 * passed.v * math.cos(angle / 2), 0.1 * passed.v * math.sin(angle / 2), angle)
        moved += abs(0.1 * passed.v)
        assert np.hypot(*(posts_xy - (base.x, base.y)).T).min() > SETTINGS.robot_radius
    assert moved > 2.0


@pytest.mark.parametrize(
    "values, reason",
    [
        ({"robot_radius": 0.0}, "robot_radius must be positive"),
        ({"time_to_collision": 0.0}, "time_to_collision must be positive"),
        ({"footprint": ((0.0, 0.0), (1.0, 0.0))}, "footprint must be at least 3 points"),
    ],
)
def test_invalid_settings_are_refused(values, reason):
    with pytest.raises(SettingsError, match=reason):
        MonitorSettings(**values)


def test_the_configuration_contains_the_defaults():
    path = Path(__file__).parents[1] / "config" / "collision_monitor.yaml"
    values = yaml.safe_load(path.read_text())
    assert values == {**asdict(MonitorSettings()), "footprint": []}
