"""The commands behind the scripts: parse, check, launch, watch, judge."""

import argparse
import os
import signal
import sys
from pathlib import Path
from typing import List, Optional

from home_service.display import complain
from home_service.errors import LaunchError, RunInterruptedError
from planar import PlanarError

ROOT = Path(__file__).resolve().parents[4]
BAD_INPUT, FAILURE, INTERRUPTED = 2, 1, 130


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs one command; returns its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    signal.signal(signal.SIGINT, _interrupt)
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        options = parse(arguments)
        check_inputs(options)
        from home_service import commands

        return getattr(commands, options.command)(options)
    except RunInterruptedError:
        complain("interrupted")
        return INTERRUPTED
    except LaunchError as error:
        complain(str(error))
        return BAD_INPUT if error.is_bad_input else FAILURE
    except PlanarError as error:
        complain(str(error))
        return BAD_INPUT


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="home_service", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, text in COMMANDS.items():
        command = commands.add_parser(
            name,
            prog=f"{name}.sh",
            description=text,
            help=text,
            formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        )
        _add_common_options(command)
        if name == "test_navigation":
            command.add_argument(
                "--goals", type=goal_list, metavar='"X Y YAW; X Y YAW"', help="drive to these poses, then end"
            )
        if name in ("home_service", "pick_objects", "add_marker"):
            command.add_argument("--zones", type=Path, default=ROOT / "map/zones.yaml", help="YAML of zones")
        if name == "home_service":
            command.add_argument(
                "--marker-source",
                choices=("tf", "amcl_pose", "odom", "state"),
                default="tf",
                help="what tells the marker where the robot is",
            )
    return parser.parse_args(arguments)


COMMANDS = {
    "launch": "Starts the simulated home with the robot in it, until Ctrl-C.",
    "test_navigation": "Starts home, localization and navigation; goals by hand or from --goals.",
    "pick_objects": "Drives to the pick-up zone, waits there, and on to the drop-off zone.",
    "add_marker": "Shows the object at pick-up, hides it, and shows it at drop-off, by the clock.",
    "home_service": "Fetches the object at the pick-up zone and delivers it at the drop-off zone.",
}


def goal_list(text: str) -> List[List[float]]:
    """Poses from "x y yaw; x y yaw" in metres and radians."""
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


def speed_factor(text: str) -> float:
    try:
        speed = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None
    if not 0.0 <= speed <= 1000.0:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1000")
    return speed


def check_inputs(options: argparse.Namespace) -> None:
    """Reads every file that was named, so that a mistake is told before anything is started."""
    from planar import load_map
    from planar.places import places_of_errand
    from sim_bridge.world import load_world

    load_world(options.world)
    load_map(options.map)
    options.places = {}
    if "zones" in options:
        options.places = {place.name: place for place in places_of_errand(options.zones)}


def _add_common_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--world", type=Path, default=ROOT / "map/home.world", help="SDF world")
    parser.add_argument("--map", type=Path, default=ROOT / "map/home.yaml", help="map of that world")
    parser.add_argument("--robot", default="turtlebot_lidar", help="robot profile of sim_bridge")
    parser.add_argument("--seed", type=int, default=0, help="seed of every noise and every particle")
    parser.add_argument(
        "--speed",
        type=speed_factor,
        default=None,
        help="1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz 1)",
    )
    parser.add_argument("--rviz", action="store_true", help="show the run in rviz, where there is a display")
    parser.add_argument("--timeout", type=float, default=900.0, help="wall-clock seconds that a run may take")
    parser.add_argument("--output", type=Path, default=Path.cwd() / "runs", help="where run folders are made")


def _interrupt(number, _frame):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise RunInterruptedError(signal.Signals(number).name)


if __name__ == "__main__":
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    code = main()
    sys.stdout.flush()
    os._exit(code)
