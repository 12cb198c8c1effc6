"""The command line of run_project."""

import argparse
import math
from pathlib import Path


def _speed(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value >= 0.0):
        raise argparse.ArgumentTypeError(f"must be 0 or more, got {text}")
    return value


def _seconds(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"must be positive, got {text}")
    return value


def parse(arguments=None) -> argparse.Namespace:
    """Options as attributes; what stands after ``--`` is ``script_arguments``."""
    parser = argparse.ArgumentParser(prog="run_project.sh", allow_abbrev=False)
    parser.add_argument("path", metavar="PATH", type=Path, help="the project's checkout")
    parser.add_argument(
        "script", metavar="SCRIPT", nargs="?", help="the script to run (default: home_service.sh)"
    )
    parser.add_argument(
        "--speed", type=_speed, help="1 real time, N times that, 0 as fast as the nodes keep up"
    )
    parser.add_argument("--seed", type=int, default=0, help="of every noise (default: 0)")
    parser.add_argument("--timeout", type=_seconds, default=600.0, help="seconds of wall time")
    parser.add_argument("--rviz", action="store_true", help="show it in rviz")
    parser.add_argument("--record", action="store_true", help="record a bag into the run folder")
    parser.add_argument("--build-only", action="store_true", help="end after the build")
    parser.add_argument("--output", type=Path, default=Path("runs"), help="where the run folder is made")
    words = list(arguments)
    after = []
    if "--" in words:
        after = words[words.index("--") + 1 :]
        words = words[: words.index("--")]
    options = parser.parse_args(words)
    options.script_arguments = after
    if options.speed is None:
        options.speed = float(options.rviz)
    return options
