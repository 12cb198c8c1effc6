"""The checks of recovery behaviours."""

import math
from typing import Any, List

from move_base_lite.check.maps import PERIOD, PICTURES, CheckMap, check_map
from move_base_lite.plugin import Plugin
from move_base_lite.recovery import RecoveryContext
from planar import Pose2, Twist2
from planar.contract_check import CheckFailed, expect

LONGEST = 60.0


def terminates(plugin: Plugin[Any]) -> None:
    """It ends by itself, wherever it is begun, and the robot touches nothing meanwhile."""
    for name in PICTURES:
        room = check_map(name)
        hit = next((pose for pose in _run(plugin, room) if room.costmap.collides(pose)), None)
        expect(hit is None, f"{name}: touches something at {hit}")


def is_deterministic(plugin: Plugin[Any]) -> None:
    """The same calls give the same answers."""
    first, second = (_run(plugin, check_map("corner")) for _ in range(2))
    expect(first == second, "another drive in the same picture")


def _run(plugin: Plugin[Any], room: CheckMap) -> List[Pose2]:
    """The poses of a robot that does at once what the behaviour says."""
    behavior = plugin.make(plugin.settings())
    pose, twist, poses = Pose2(*room.start_xy, 0.0), Twist2(), []
    for _ in range(round(LONGEST / PERIOD)):
        poses.append(pose)
        context = RecoveryContext(pose, pose, twist, PERIOD, room.costmap, room.costmap, lambda limit: None)
        command = behavior.step(context)
        if command is None:
            return poses
        twist, half_turn = command, 0.5 * command.omega * PERIOD
        way = command.v * PERIOD
        pose = pose @ Pose2(way * math.cos(half_turn), way * math.sin(half_turn), 2.0 * half_turn)
    raise CheckFailed(f"not at an end after {LONGEST:g} s")


CHECKS = (terminates, is_deterministic)
