"""What is known of a recording beside its bags: the run that it was made in."""

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Dict, Sequence

from home_service.options import LaunchPlan
from planar.files.reading import is_file, read_text
from sim_bridge import RobotError, robot_named


def recording_plan(bags: Sequence[Path], stays: bool = False) -> LaunchPlan:
    """All that is in the bags played, in the world and with the robot of their run, if it told them."""
    names = os.pathsep.join(str(path.resolve()) for path in bags)
    arguments = {"bags": names, "stays": str(stays).lower(), **_stage_of(bags[0])}
    return LaunchPlan("recording.launch", arguments, is_simulated=False)


def _stage_of(bag: Path) -> Dict[str, str]:
    """Arguments for its launch file, by the result.json of the run that the bag is of, if there is one."""
    try:
        told = json.loads(read_text(bag.resolve().parent.parent / "result.json"))
    except (OSError, ValueError, RecursionError):
        return {}
    world, robot = (told.get(key) if isinstance(told, dict) else None for key in ("world", "robot"))
    stage = {}
    if isinstance(world, str) and is_file(Path(world)):
        stage["world_file"] = world
    if isinstance(robot, str):
        with suppress(RobotError):
            robot_named(robot)
            stage["robot"] = robot
    return stage
