"""Contract checks of recovery behaviours."""

from typing import Any, List

from move_base_lite.check.maps import PERIOD, PICTURES, CheckMap, check_map, moved
from move_base_lite.recovery import RecoveryContext
from planar import Pose2, Twist2
from planar.extensions import Plugin
from planar.extensions.check import CheckFailed, expect, same_results

MAX_DURATION = 60.0


def terminates(plugin: Plugin[Any]) -> None:
    """It ends without a collision on every map."""
    for name in PICTURES:
        room = check_map(name)
        hit = next((pose for pose in _run(plugin, room) if room.costmap.collides(pose)), None)
        expect(hit is None, f"{name}: collides at {hit}")


def _run(plugin: Plugin[Any], room: CheckMap) -> List[Pose2]:
    """The poses of a robot that executes the behaviour's commands without delay."""
    behavior = plugin.make(plugin.settings())
    pose, twist, poses = Pose2(*room.start_xy, 0.0), Twist2(), []
    for _ in range(round(MAX_DURATION / PERIOD)):
        poses.append(pose)
        context = RecoveryContext(pose, pose, twist, PERIOD, room.costmap, room.costmap, lambda limit: None)
        command = behavior.step(context)
        if command is None:
            return poses
        twist = command
        pose = moved(pose, command)
    raise CheckFailed(f"did not end within {MAX_DURATION:g} s")


CHECKS = (terminates, same_results(lambda plugin: _run(plugin, check_map("corner"))))
