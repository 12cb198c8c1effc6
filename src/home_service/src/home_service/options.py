"""The command line of each command."""

import argparse
import math
from pathlib import Path
from typing import List, Optional

ROOT = Path(__file__).resolve().parents[4]
MAX_SPEED = 1000.0
RUN_SECONDS = 900.0

COMMANDS = {
    "launch": "Starts the simulated home with the robot in it, until Ctrl-C.",
    "test_navigation": "Starts home, localization and navigation; goals by hand or from --goals.",
    "pick_objects": "Carries out a mission, by default from the pick-up to the drop-off zone.",
    "add_marker": "Shows the object at pick-up, hides it, and shows it at drop-off, by the clock.",
    "home_service": "Fetches the object at the pick-up zone and delivers it at the drop-off zone.",
    "follow": "Lets a second robot follow the first, while that does its errand.",
    "test_slam": "Starts home and SLAM, driven with keys (terminal or pipe), or by itself; saves the map.",
    "map_home": "Lets the robot explore the world, saves its map, and scores it against the true one.",
    "report": "Makes the report of a run anew, from what its folder holds.",
    "compare": "Puts two runs side by side: a table here, and a page.",
    "doctor": "Says what is running, what each node waits for, and what is wrong.",
    "replay": "Plays recorded bags to localization or mapping, and measures what they make of them.",
    "rehearse": "Plays the home-service mission in one process, without ROS: fast and repeatable.",
}
MAPPING_COMMANDS = {"test_slam", "map_home"}
REPORT_COMMANDS = {"report", "compare"}
ROS_COMMANDS = set(COMMANDS) - REPORT_COMMANDS - {"rehearse", "doctor", "replay"}


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    """The options of the command that ``arguments`` name; ends the process on --help and on nonsense."""
    parser = argparse.ArgumentParser(prog="home_service", description="The commands behind the scripts.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, text in COMMANDS.items():
        command = commands.add_parser(
            name,
            prog=f"{name}.sh",
            description=text,
            help=text,
            formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        )
        if name in REPORT_COMMANDS:
            _add_report_options(name, command)
            continue
        if name == "replay":
            _add_replay_options(command)
            continue
        if name == "doctor":
            _add_doctor_options(command)
            continue
        _add_world_options(command)
        if name in ROS_COMMANDS:
            _add_graph_options(command)
        _add_own_options(name, command)
    options = parser.parse_args(arguments)
    if "timeout" not in options:
        options.timeout = math.inf if _ends_with_ctrl_c(options) else RUN_SECONDS
    return options


def _ends_with_ctrl_c(options: argparse.Namespace) -> bool:
    """Whether it is a person who ends the run."""
    return (
        options.command == "launch"
        or (options.command == "home_service" and options.serve)
        or (options.command == "test_navigation" and options.goals is None)
        or (options.command == "test_slam" and options.drive == "keys")
    )


def _add_report_options(name: str, parser: argparse.ArgumentParser) -> None:
    if name == "report":
        parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run")
        parser.add_argument("--gif", action="store_true", help="also make run.gif, the run as an animation")
    else:
        parser.add_argument("first", type=Path, metavar="A", help="folder of a run")
        parser.add_argument("second", type=Path, metavar="B", help="folder of another run")
        parser.add_argument("--page", type=Path, metavar="FILE", help="where the page goes, not to B")


def _add_replay_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "bags", type=Path, nargs="+", metavar="BAG", help="bags, or folders of them or of runs"
    )
    parser.add_argument(
        "--with",
        dest="estimator",
        choices=("amcl", "slam", "recorded"),
        default="amcl",
        help="localize, map, or only show what was recorded",
    )
    parser.add_argument("--map", type=Path, default=ROOT / "map/home.yaml", help="for amcl: the map")
    parser.add_argument(
        "--start",
        type=float,
        nargs=3,
        default=(0.0, 0.0, 0.0),
        metavar=("X", "Y", "YAW"),
        help="for amcl: where the robot starts in the map",
    )
    parser.add_argument("--seed", type=seed, default=0, help="of every particle")
    parser.add_argument("--save", type=Path, metavar="STEM", help="for slam: where to save the map")
    _add_run_options(parser)


def _add_doctor_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print for programs")
    parser.add_argument("--master", metavar="URI", help="of the graph to look at, if there are several")
    parser.add_argument("--seconds", type=seconds, default=2.0, help="how long rates are measured")


def _add_world_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--world", type=Path, default=ROOT / "map/home.world", help="SDF world")
    parser.add_argument("--robot", default="turtlebot_lidar", help="robot profile of sim_bridge")
    parser.add_argument("--seed", type=seed, default=0, help="seed of every noise and every particle")


def _add_graph_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--record", choices=("inputs", "all"), help="record bags: scans, odometry and truth, or everything"
    )
    _add_run_options(parser)


def _add_run_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--speed",
        type=speed_factor,
        default=argparse.SUPPRESS,
        help="1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz 1)",
    )
    parser.add_argument("--rviz", action="store_true", help="show the run in rviz, where there is a display")
    parser.add_argument(
        "--timeout",
        type=seconds,
        default=argparse.SUPPRESS,
        help=f"wall-clock seconds a run may take (default: {RUN_SECONDS:g}; none for what Ctrl-C ends)",
    )
    parser.add_argument("--gif", action="store_true", help="also leave run.gif, the run as an animation")
    parser.add_argument("--output", type=Path, default=Path("runs"), help="where run folders are made")


def _add_own_options(name: str, parser: argparse.ArgumentParser) -> None:
    if name in MAPPING_COMMANDS:
        parser.add_argument(
            "--save", type=Path, metavar="STEM", help="write STEM.pgm and STEM.yaml, not to the run folder"
        )
    else:
        parser.add_argument("--map", type=Path, default=ROOT / "map/home.yaml", help="map of that world")
    if name == "test_slam":
        parser.add_argument("--drive", choices=("keys", "auto"), default="keys", help="who drives the robot")
    if name in ("home_service", "pick_objects", "add_marker", "follow", "rehearse"):
        parser.add_argument("--zones", type=Path, default=ROOT / "map/zones.yaml", help="YAML of zones")
    if name in ("home_service", "pick_objects", "rehearse"):
        parser.add_argument("--mission", type=Path, metavar="FILE", help="YAML of deliveries")
    if name == "home_service":
        parser.add_argument(
            "--serve", action="store_true", help="wait for missions sent to the action deliver, until Ctrl-C"
        )
    if name == "test_navigation":
        parser.add_argument(
            "--goals", type=goal_list, metavar='"X Y YAW; X Y YAW"', help="drive to these poses, then end"
        )
    if name == "home_service":
        parser.add_argument(
            "--marker-source",
            choices=("tf", "amcl_pose", "odom", "state"),
            default="tf",
            help="what tells the marker where the robot is",
        )
    if name == "rehearse":
        parser.add_argument("--runs", type=count, default=1, help="how many runs, each with the next seed")
        parser.add_argument("--timeout", type=seconds, default=600.0, help="simulated seconds a run may take")


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
    speed = _number(text)
    if not 0.0 <= speed <= MAX_SPEED:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and {MAX_SPEED:g}")
    return speed


def seconds(text: str) -> float:
    value = _number(text)
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not positive")
    return value


def seed(text: str) -> int:
    return _whole_number(text, 0)


def count(text: str) -> int:
    return _whole_number(text, 1)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None


def _whole_number(text: str, least: int) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least}")
    return int(text)
