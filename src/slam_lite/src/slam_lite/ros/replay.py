"""Offline mapping of a recorded bag: ``slam_lite_replay BAG --map OUT``."""

from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional

from planar import PlanarError, save_map
from planar_ros.bags.offline_replay import (
    ReplayOptions,
    load_settings,
    process_scans,
    run_replay,
    warn,
    write_trajectory,
)
from planar_ros.bags.scan_log import LoggedScan, NoResultError, ScanLog
from slam_lite.config import NodeSettings
from slam_lite.mapper import Mapper
from slam_lite.scan_trajectory import ScanTrajectory
from supervision.command_line import option


@dataclass(frozen=True)
class SlamReplay(ReplayOptions):
    """Map a recorded bag, without a ROS master."""

    map: Optional[Path] = option(None, "write OUT.pgm and OUT.yaml", type=Path, metavar="OUT")
    pose_of: str = option(
        "laser",
        "frame of the trajectory's poses: laser, where the scans were taken, or base",
        choices=("laser", "base"),
    )
    base_frame: str = option("base_link", "the robot's frame", flag="--base_frame", metavar="FRAME")
    odom_frame: str = option("odom", "odometry's frame", flag="--odom_frame", metavar="FRAME")


def main(arguments: Optional[List[str]] = None) -> int:
    """Map a recorded bag.

    Args:
        arguments: Command line without the program's name; by default that of the process.

    Returns:
        Exit code: 0; 1 if no useful map came of it, or the bag is truncated and the part before is saved; 2
        for invalid input.
    """
    return run_replay(SlamReplay, "slam_lite_replay", _replay, arguments)


def _replay(options: SlamReplay) -> int:
    mapper, trajectory = Mapper(load_settings(NodeSettings, options.config)), ScanTrajectory()
    exit_code = _work_through(options, mapper, trajectory)
    if not mapper.has_obstacles:
        raise NoResultError(
            f"{options.bag}: no reading on {options.scan_topic} is valid (between range_min and range_max): "
            "nothing to map"
        )
    mapper.run_final_optimization()
    _save(options, mapper, trajectory)
    keyframes = len(mapper.keyframe_poses)
    print(f"{len(trajectory)} scans, {keyframes} keyframes, {mapper.loop_count} loop closures")
    if keyframes == 1 and exit_code == 0:
        warn(f"{options.bag}: the robot did not move: the map shows what it saw from one place")
        return 1
    return exit_code


def _work_through(options: SlamReplay, mapper: Mapper, trajectory: ScanTrajectory) -> int:
    """Map all scans, and free the bag's index."""
    log = ScanLog(options.bag, options.scan_topic, options.base_frame, options.odom_frame, warn)

    def insert(logged: LoggedScan) -> None:
        update = None
        try:
            update = mapper.insert(logged.base_in_odom, logged.scan)
        except PlanarError as error:
            warn(f"{options.bag}: scan ignored: {error}")
        trajectory.add(logged.base_in_odom, logged.scan, update)

    exit_code = process_scans(log, insert, "mapping", options.progress)
    print(log)
    return exit_code


def _save(options: SlamReplay, mapper: Mapper, trajectory: ScanTrajectory) -> None:
    """Write the requested files; the map also when the trajectory cannot be written."""
    try:
        if options.trajectory:
            of_laser = options.pose_of == "laser"
            write_trajectory(options.trajectory, trajectory.poses(mapper.keyframe_poses, of_laser=of_laser))
    finally:
        if options.map:
            save_map(mapper.grid_in_bands(), options.map)
