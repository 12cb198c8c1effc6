"""Localizes in a recorded bag, offline, as fast as the machine allows: ``amcl_lite_replay BAG --map MAP``."""

import argparse
import sys
from pathlib import Path
from typing import List, Optional, Tuple

import numpy as np

from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.localizer import LocalizationError, Localizer
from planar import PlanarError, Pose2, load_map, wrap, write_atomically
from planar.config.parameters import official_names
from planar.config.settings_file import settings_from_yaml
from planar.files.tum import tum_text
from planar_ros.bags.scan_log import BagError, ScanLog


def main(arguments: Optional[List[str]] = None) -> int:
    """Returns 0; 1 if the bag broke off, and what was localized is written; 2 if nothing was."""
    options = _parser().parse_args(arguments)
    try:
        return _replay(options)
    except PlanarError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="amcl_lite_replay",
        description="Localize a robot in a recorded bag, without a master. The same bag, map, parameters and "
        "seed give the same trajectory. If the bag holds the truth, the errors are told.",
    )
    parser.add_argument("bag", metavar="BAG", help="a ROS 1 bag with scans and /tf")
    parser.add_argument("--map", metavar="YAML", type=Path, required=True, help="the map, as for map_server")
    parser.add_argument(
        "--trajectory",
        metavar="OUT.tum",
        type=Path,
        help="where to write the pose in the map at every scan (default: the name of the bag, here)",
    )
    parser.add_argument("--global", dest="everywhere", action="store_true", help="the start is not known")
    parser.add_argument("--seed", type=int, help="of all chance (default: that of the parameters, 0)")
    parser.add_argument("--config", metavar="YAML", type=Path, help="parameters of amcl")
    parser.add_argument(
        "--start",
        metavar=("X", "Y", "YAW"),
        type=float,
        nargs=3,
        help="where the robot starts in the map (default: the initial_pose_* of the parameters, 0 0 0)",
    )
    parser.add_argument("--scan_topic", default="/scan", help="default: /scan")
    parser.add_argument(
        "--truth_topic", default="base_pose_ground_truth", help="default: base_pose_ground_truth"
    )
    return parser


def _replay(options: argparse.Namespace) -> int:
    settings, start = _settings(options.config)
    seed = settings.seed if options.seed is None else options.seed
    rng = np.random.default_rng(seed if seed >= 0 else None)
    log = ScanLog(options.bag, options.scan_topic, settings.base_frame, settings.odom_frame, _warn)
    localizer = Localizer(load_map(options.map), settings, rng)
    localizer.set_pose(Pose2(*options.start) if options.start else start.pose, start.covariance)
    if options.everywhere:
        localizer.scatter()
    stamped_poses, exit_code = [], 0
    try:
        for logged in log:
            try:
                localizer.update(logged.base_in_odom, logged.scan, logged.laser)
            except LocalizationError as error:
                _warn(f"{options.bag}: scan ignored: {error}")
            if localizer.odom_in_map is not None:
                base_in_map = localizer.odom_in_map @ logged.base_in_odom
                stamped_poses.append((logged.scan.stamp, *base_in_map.as_array()))
    except BagError as error:
        _warn(str(error))
        exit_code = 1
    if not stamped_poses:
        raise BagError(f"{options.bag}: no scan on {options.scan_topic} could be used")
    trajectory = options.trajectory or Path(Path(options.bag).stem + ".tum")
    write_atomically(trajectory, tum_text(np.array(stamped_poses)).encode("ascii"))
    print(f"{len(stamped_poses)} poses, the last one {_text(stamped_poses[-1])}: {trajectory}")
    truth = log.truth(options.truth_topic)
    if len(truth) > 0:
        print(_error_figures(*errors_of(np.array(stamped_poses), truth)))
    return exit_code


def errors_of(stamped_poses: np.ndarray, truth: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """How far poses (N, 4) ``[t, x, y, yaw]`` are from the truth (M, 4) at their stamps: metres, radians."""
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


def _settings(path: Optional[Path]) -> Tuple[NodeSettings, InitialPose]:
    if path is None:
        return NodeSettings(), InitialPose()
    settings, unknown = settings_from_yaml(NodeSettings, path)
    start, _ = settings_from_yaml(InitialPose, path)
    for name in unknown:
        if name not in official_names(InitialPose):
            _warn(f"{path}: {name} has no meaning here")
    return settings, start


def _text(stamped_pose) -> str:
    return "({:.3f}, {:.3f}, {:.3f})".format(*stamped_pose[1:])


def _warn(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)
