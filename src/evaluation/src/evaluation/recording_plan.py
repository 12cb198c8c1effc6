"""Launch plan for the playback of a recording."""

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Dict, Sequence

from evaluation.options import LaunchPlan
from planar.files.reading import is_file, read_text
from sim_bridge import RobotError, robot_named


def recording_plan(bags: Sequence[Path], stays: bool = False, tool: str = "replay") -> LaunchPlan:
    """Plan the playback of bags in the world and with the robot of their run.

    Args:
        bags: Bags in the order of time.
        stays: Keep running at the end, so that one can seek back.
        tool: Tool of the cockpit that is open at first.
    """
    names = os.pathsep.join(str(path.resolve()) for path in bags)
    arguments = {"bags": names, "stays": str(stays).lower(), **_world_and_robot(bags[0])}
    return LaunchPlan("recording.launch", arguments, is_simulated=False, tool=tool)


def _world_and_robot(bag: Path) -> Dict[str, str]:
    """Return world and robot from the result.json of the run that recorded a bag, as launch arguments."""
    try:
        result = json.loads(read_text(bag.resolve().parent.parent / "result.json"))
    except (OSError, ValueError, RecursionError):
        return {}
    world, robot = (result.get(key) if isinstance(result, dict) else None for key in ("world", "robot"))
    stage = {}
    if isinstance(world, str) and is_file(Path(world)):
        stage["world_file"] = world
    if isinstance(robot, str):
        with suppress(RobotError):
            robot_named(robot)
            stage["robot"] = robot
    return stage
