"""Localize offline in a recorded bag, as fast as possible: ``amcl_lite_replay BAG --map MAP``."""

from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Tuple

import numpy as np

from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.localizer import Localizer
from planar import Pose2, load_map, wrap
from planar.config.parameters import official_names, settings_from_yaml
from planar_ros.bags.offline_replay import (
    ReplayOptions,
    load_settings,
    process_scans,
    run_replay,
    warn,
    write_trajectory,
)
from planar_ros.bags.scan_log import LoggedScan, NoResultError, ScanLog
from supervision.command_line import option


@dataclass(frozen=True)
class AmclReplay(ReplayOptions):
    """Localize a robot in a recorded bag, without a master.

    The same bag, map, parameters and seed give the same trajectory. It is written to the current folder under
    the name of the bag if no file is given. If the bag contains ground truth, the errors are printed.
    """

    map: Optional[Path] = option(
        None, "the map, as for map_server (required)", type=Path, metavar="YAML", required=True
    )
    everywhere: bool = option(False, "start with global localization", flag="--global")
    seed: Optional[int] = option(None, "seed of all random numbers (default: parameter seed, 0)", type=int)
    start: Optional[Tuple[float, float, float]] = option(
        None,
        "where the robot starts in the map (default: the initial_pose_* of the parameters, 0 0 0)",
        type=float,
        nargs=3,
        metavar=("X", "Y", "YAW"),
    )
    truth_topic: str = option(
        "base_pose_ground_truth", "topic of the ground truth", flag="--truth_topic", metavar="TOPIC"
    )


def main(arguments: Optional[List[str]] = None) -> int:
    """Run the command.

    Returns:
        0; 1 if the bag was truncated or nothing could be localized; 2 for invalid input.
    """
    return run_replay(AmclReplay, "amcl_lite_replay", _replay, arguments)


def _replay(options: AmclReplay) -> int:
    settings = load_settings(NodeSettings, options.config, also_known=official_names(InitialPose))
    localizer = _localizer(options, settings)
    log = ScanLog(options.bag, options.scan_topic, settings.base_frame, settings.odom_frame, warn)
    stamped_poses: List[Tuple[float, ...]] = []

    def update(logged: LoggedScan) -> None:
        try:
            localizer.update(logged.base_in_odom, logged.scan, logged.laser)
        except LocalizationError as error:
            warn(f"{options.bag}: scan ignored: {error}")
        if localizer.odom_in_map is not None:
            base_in_map = localizer.odom_in_map @ logged.base_in_odom
            stamped_poses.append((logged.scan.stamp, *base_in_map.as_array()))

    exit_code = process_scans(log, update, "localizing", options.progress)
    print(log)
    if not stamped_poses:
        raise NoResultError(f"{options.bag}: no scan on {options.scan_topic} could be used")
    if not log.frames.has_odometry:
        raise NoResultError(f"{options.bag}: no odometry: only a robot with odometry can be localized")
    trajectory = options.trajectory or Path(Path(options.bag).stem + ".tum")
    write_trajectory(trajectory, np.array(stamped_poses))
    print(f"{len(stamped_poses)} poses, the last one {_text(stamped_poses[-1])}: {trajectory}")
    truth = log.truth(options.truth_topic)
    if len(truth) > 0:
        print(_error_figures(*errors_of(np.array(stamped_poses), truth)))
    return exit_code


def _localizer(options: AmclReplay, settings: NodeSettings) -> Localizer:
    """Create the Localizer at the start pose of the options or of the parameters."""
    seed = settings.seed if options.seed is None else options.seed
    rng = np.random.default_rng(seed if seed >= 0 else None)
    start = settings_from_yaml(InitialPose, options.config)[0] if options.config else InitialPose()
    localizer = Localizer(load_map(options.map), settings, rng)
    localizer.set_pose(Pose2(*options.start) if options.start else start.pose, start.covariance)
    if options.everywhere:
        localizer.start_global_localization()
    return localizer


def errors_of(stamped_poses: np.ndarray, truth: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Compute the errors of poses (N, 4) ``[t, x, y, yaw]`` against ground truth (M, 4) [m, rad]."""
    stamps = stamped_poses[:, 0]
    x, y, yaw = (
        np.interp(stamps, truth[:, 0], values) for values in (*truth[:, 1:3].T, np.unwrap(truth[:, 3]))
    )
    distances = np.hypot(stamped_poses[:, 1] - x, stamped_poses[:, 2] - y)
    return distances, np.abs(wrap(stamped_poses[:, 3] - yaw))


def _error_figures(distances: np.ndarray, angles: np.ndarray) -> str:
    return (
        f"position error: mean {distances.mean():.4f} m, rmse {np.sqrt(np.mean(distances**2)):.4f} m, "
        f"95 % below {np.percentile(distances, 95):.4f} m, largest {distances.max():.4f} m, "
        f"last {distances[-1]:.4f} m\n"
        f"heading error: mean {angles.mean():.4f} rad, rmse {np.sqrt(np.mean(angles**2)):.4f} rad, "
        f"last {angles[-1]:.4f} rad"
    )


def _text(stamped_pose) -> str:
    return "({:.3f}, {:.3f}, {:.3f})".format(*stamped_pose[1:])
