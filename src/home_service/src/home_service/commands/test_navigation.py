import argparse
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

from evaluation.options import DrivingOptions, GraphOptions
from supervision.command_line import option


def goal_list(text: str) -> List[List[float]]:
    """Parse poses from "x y yaw; x y yaw" [m, rad]."""
    goals = []
    for part in filter(str.strip, text.split(";")):
        try:
            goal = [float(number) for number in part.split()]
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{part.strip()}' is not three numbers") from None
        if len(goal) != 3:
            raise argparse.ArgumentTypeError(f"'{part.strip()}' is not three numbers: x, y, yaw")
        goals.append(goal)
    if not goals:
        raise argparse.ArgumentTypeError("no goal given")
    return goals


@dataclass(frozen=True)
class TestNavigation(GraphOptions, DrivingOptions):
    """Start home, localization and navigation; goals by hand or from --goals.

    Exit code: 0 success, and Ctrl-C without --goals; 1 failure or no result.json, 2 invalid input, 130
    interrupted.
    """

    goals: Optional[Tuple[Sequence[float], ...]] = option(
        None,
        "drive to these poses of the map (metres, radians), then end",
        type=goal_list,
        metavar='"X Y YAW; X Y YAW"',
    )

    @property
    def is_interactive(self) -> bool:
        return self.goals is None

    def run(self) -> int:
        from evaluation.ros.run_modes import run_until_interrupted
        from headless_mission.inputs import read_goals
        from home_service.ros.goal_sequence import drive_to_goals
        from planar import Pose2

        goals = [Pose2(*goal) for goal in self.goals or ()]
        read_goals(self, goals)
        launch = self.launch("navigation.launch", **self.files())
        if self.goals is None:
            hint = "send goals to /move_base_simple/goal or to the action /move_base; Ctrl-C ends"
            return run_until_interrupted(self, launch, hint)
        return drive_to_goals(self, launch, goals)
