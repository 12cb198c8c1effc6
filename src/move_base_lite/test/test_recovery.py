"""The contract of recovery behaviours, and their effects on a small map."""

import math

import numpy as np
import pytest
from costmap_with_layers import costmap_with

from move_base_lite.check import CHECK_SUITES
from move_base_lite.costmap import LETHAL, observation_from_points
from move_base_lite.costmap.costmap import LayeredCostmap
from move_base_lite.costmap.layers.obstacles import ObstacleSettings, SourceSettings
from move_base_lite.recovery import (
    RECOVERIES,
    ClearCostmapSettings,
    MoveSlowSettings,
    RecoveryContext,
    RotateSettings,
)
from planar import Pose2, SettingsError, Twist2, wrap

PERIOD = 0.1
NEAR_XY, FAR_XY = (5.5, 5.0), (8.0, 5.0)
HERE = Pose2(5.0, 5.0)


class RecoveryBench:
    """An ideal robot on costmaps with a near and a far obstacle.

    ``slip`` is the fraction of commanded rotation that it does not make.
    """

    def __init__(self, pose=HERE, slip=0.0, **footprint):
        self.limits, self.slip = [], slip
        self.pose, self.twist = pose, Twist2()
        sources = (SourceSettings(topic="cloud", obstacle_range=9.0, raytrace_range=9.0),)
        settings = costmap_with(
            obstacles=ObstacleSettings(sources=sources), **(footprint or {"robot_radius": 0.2})
        )
        self.costmaps = [LayeredCostmap(settings) for _ in range(2)]
        points_xyz = np.array([(*NEAR_XY, 0.1), (*FAR_XY, 0.1)]) - (5.0, 5.0, 0.0)
        for costmap in self.costmaps:
            costmap.add_observation(observation_from_points("cloud", 0.0, Pose2(), points_xyz), HERE)
            costmap.update(pose)

    def run(self, settings, seconds=30.0):
        """Commands until the behaviour has finished."""
        behavior, commands = RECOVERIES.make(settings), []
        while len(commands) * PERIOD < seconds:
            command = behavior.step(
                RecoveryContext(
                    self.pose, self.pose, self.twist, PERIOD, *self.costmaps, limit_speed=self.limits.append
                )
            )
            if command is None:
                return commands
            commands.append(command)
            self.twist = Twist2(command.v, (1.0 - self.slip) * command.omega)
            self.pose = self.pose @ Pose2(0.0, 0.0, self.twist.omega * PERIOD)
        raise AssertionError(f"the behaviour has not finished after {seconds} s")

    def marked(self, xy):
        """Whether there is an obstacle, in the global and in the local costmap."""
        return tuple(costmap.costs[costmap.window.cell_of(*xy)] == LETHAL for costmap in self.costmaps)


@pytest.mark.parametrize("check", CHECK_SUITES["recovery_behavior"].checks, ids=lambda check: check.__name__)
@pytest.mark.parametrize("member", RECOVERIES.members, ids=lambda member: member.short_name)
def test_a_behaviour_fulfils_the_contract(member, check):
    check(member)


@pytest.mark.parametrize("member", RECOVERIES.members, ids=lambda member: member.short_name)
def test_each_behaviour_finishes_without_driving(member):
    bench = RecoveryBench()
    commands = bench.run(member.settings())
    assert all(command.v == 0.0 for command in commands)
    assert math.dist((bench.pose.x, bench.pose.y), (HERE.x, HERE.y)) == 0.0


@pytest.mark.parametrize(
    "values, near, far",
    [
        ({}, (True, True), (False, False)),
        ({"invert_area_to_clear": True}, (False, False), (True, True)),
        ({"affected_maps": "global"}, (True, True), (False, True)),
        ({"affected_maps": "local"}, (True, True), (True, False)),
    ],
)
def test_clearing_removes_obstacles_outside_or_inside_the_square(values, near, far):
    bench = RecoveryBench()
    assert bench.marked(NEAR_XY) == bench.marked(FAR_XY) == (True, True)
    assert bench.run(ClearCostmapSettings(reset_distance=3.0, **values)) == []
    assert (bench.marked(NEAR_XY), bench.marked(FAR_XY)) == (near, far)


def test_rotate_recovery_is_a_full_turn_to_the_left_within_the_limits():
    settings = RotateSettings(max_vel_theta=0.8, acc_lim_theta=2.0)
    commands = RecoveryBench().run(settings)
    turned = sum(command.omega * PERIOD for command in commands)
    assert turned == pytest.approx(2.0 * math.pi, abs=settings.yaw_goal_tolerance)
    rates = [0.0, *(command.omega for command in commands)]
    assert max(rates) <= settings.max_vel_theta
    assert max(np.diff(rates)) <= settings.acc_lim_theta * PERIOD + 1e-9


@pytest.mark.parametrize("slip, turned", [(1.0, 0.0), (0.99, 0.0), (0.5, 2.0 * math.pi)])
def test_rotate_recovery_ends_if_the_robot_does_not_turn(slip, turned):
    bench = RecoveryBench(slip=slip)
    commands = bench.run(RotateSettings())
    assert bench.pose.yaw == pytest.approx(wrap(turned), abs=0.1)
    assert turned > 0.0 or len(commands) * PERIOD < 10.0


def test_rotate_recovery_stops_before_a_collision():
    corners = ((0.7, 0.1), (0.7, -0.1), (-0.1, -0.1), (-0.1, 0.1))
    bench = RecoveryBench(Pose2(5.0, 5.0, -1.0), footprint=corners)
    bench.run(RotateSettings())
    assert -1.0 <= bench.pose.yaw < 0.0
    assert not bench.costmaps[1].collides(bench.pose)


def test_move_slow_clears_near_obstacles_and_limits_the_speed():
    bench = RecoveryBench()
    settings = MoveSlowSettings(clearing_distance=1.0, limited_trans_speed=0.1, limited_distance=0.4)
    assert bench.run(settings) == []
    assert (bench.marked(NEAR_XY), bench.marked(FAR_XY)) == ((False, False), (True, True))
    (limit,) = bench.limits
    assert (limit.highest, limit.distance) == (Twist2(0.1, settings.limited_rot_speed), 0.4)


@pytest.mark.parametrize(
    "kind, values, reason",
    [
        (ClearCostmapSettings, {"affected_maps": "none"}, "affected_maps must be local, global or both"),
        (RotateSettings, {"max_vel_theta": 0.0}, "max_vel_theta must be positive"),
        (MoveSlowSettings, {"limited_distance": -1.0}, "limited_distance must be at least 0"),
    ],
)
def test_invalid_settings_are_refused(kind, values, reason):
    with pytest.raises(SettingsError, match=reason):
        kind(**values)
