"""Maps a recorded bag, offline, as fast as the machine allows: ``slam_lite_replay BAG --map OUT``."""

import argparse
import sys
from pathlib import Path
from typing import List, Optional

from rich.console import Console
from rich.progress import Progress

from planar import PlanarError, save_map, write_atomically
from planar.config.settings_file import settings_from_yaml
from planar.files.tum import tum_text
from planar_ros.bags.scan_log import BagError, ScanLog
from slam_lite.config import NodeSettings
from slam_lite.mapper import Mapper
from slam_lite.trajectory import Trajectory


def main(arguments: Optional[List[str]] = None) -> int:
    """Returns 0; 1 if the bag broke off, and what was mapped is saved; 2 if nothing was mapped."""
    options = _parser().parse_args(arguments)
    try:
        return _replay(options)
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="slam_lite_replay", description="Map a recorded bag, without a master."
    )
    parser.add_argument("bag", metavar="BAG", help="a ROS 1 bag with scans and /tf")
    parser.add_argument("--map", metavar="OUT", type=Path, help="write OUT.pgm and OUT.yaml")
    parser.add_argument("--trajectory", metavar="OUT.tum", type=Path, help="write a pose for every scan")
    parser.add_argument(
        "--pose-of",
        choices=("laser", "base"),
        default="laser",
        help="what the trajectory tells the pose of (default: the laser, where the scans were taken)",
    )
    parser.add_argument("--progress", action="store_true", help="show how far it is")
    parser.add_argument("--config", metavar="YAML", type=Path, help="parameters of slam_gmapping")
    parser.add_argument("--scan_topic", default="/scan", help="default: /scan")
    parser.add_argument("--base_frame", default="base_link", help="default: base_link")
    parser.add_argument("--odom_frame", default="odom", help="default: odom")
    return parser


def _replay(options: argparse.Namespace) -> int:
    mapper, trajectory = Mapper(_settings(options.config)), Trajectory()
    log = ScanLog(options.bag, options.scan_topic, options.base_frame, options.odom_frame, _warn)
    exit_code = 0
    console = Console(stderr=True)
    with Progress(console=console, disable=not options.progress, transient=True) as progress:
        task = progress.add_task("mapping", total=1.0)
        try:
            for logged in log:
                update = mapper.insert(logged.base_in_odom, logged.scan)
                trajectory.add(logged.base_in_odom, logged.scan, update)
                progress.update(task, completed=logged.position)
        except BagError as error:
            _warn(str(error))
            exit_code = 1
        except KeyboardInterrupt:
            _warn(f"{options.bag}: interrupted")
            exit_code = 130
    if len(trajectory) == 0:
        raise BagError(f"{options.bag}: no scans on {options.scan_topic} could be used")
    mapper.settle()
    _save(options, mapper, trajectory)
    print(f"{len(trajectory)} scans, {len(mapper.key_poses)} kept, {mapper.loop_count} loop closures")
    return exit_code


def _save(options: argparse.Namespace, mapper: Mapper, trajectory: Trajectory) -> None:
    """Writes what was asked for; the map also when the trajectory cannot be written."""
    try:
        if options.trajectory:
            text = tum_text(trajectory.poses(mapper.key_poses, of_laser=options.pose_of == "laser"))
            write_atomically(options.trajectory, text.encode("ascii"))
    finally:
        if options.map:
            save_map(mapper.grid(), options.map)


def _settings(path: Optional[Path]) -> NodeSettings:
    if path is None:
        return NodeSettings()
    settings, unknown = settings_from_yaml(NodeSettings, path)
    for name in unknown:
        _warn(f"{path}: {name} has no meaning here")
    return settings


def _warn(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)
