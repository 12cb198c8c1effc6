"""Contract checks of user-defined sensor and motion models: ``python3 -m amcl_lite.check NAME``.

Each check receives settings that select a model.
"""

import sys

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.motion.custom_model import CONTRACT as MOTION
from amcl_lite.motion.motion_model import motion_model_of
from amcl_lite.sensor.beams import Beams, evenly_spaced_beams
from amcl_lite.sensor.custom_model import CONTRACT as SENSOR
from amcl_lite.sensor.scan_likelihood import ScanLikelihood
from planar import Pose2, Scan, grid_from_picture, wrap
from planar.deprecation import deprecated_names
from planar.extensions.check import expect, expect_unchanged, run_checks, same_results, suite
from planar.geometry.ray_casting import cast_rays

ROOM = "##########\n#........#\n#........#\n#....#...#\n#....#####\n##########"
GRID = grid_from_picture(ROOM, 0.05, scale=10)
TRUE_POSE = Pose2(1.2, 1.6, 0.4)
ANGLES, RANGE_MAX = np.linspace(-np.pi, np.pi, 90, endpoint=False), 10.0
# Motion of the odometry, and the largest mean deviation of the particles from it [m, rad].
MOTION_STEP, MAX_POSITION_BIAS, MAX_HEADING_BIAS = Pose2(0.5, 0.1, 0.4), 0.1, 0.1


def gives_finite_log_likelihoods(settings: LocalizerSettings) -> None:
    """It returns finite log-likelihoods for any scan, at poses inside and outside of the map."""
    poses = np.array([TRUE_POSE.as_array(), [0.0, 0.0, 0.0], [-50.0, 900.0, 1.0]])
    for ranges in (_ranges(), np.full(len(ANGLES), np.inf), np.full(len(ANGLES), np.nan)):
        _log_likelihoods(settings, poses, _beams(ranges, settings))


def prefers_true_pose(settings: LocalizerSettings) -> None:
    """A scan is more likely at its true pose than at offsets of 0.5 m or 0.5 rad."""
    beside = [Pose2(x, y, yaw) for x, y, yaw in np.vstack([np.eye(3), -np.eye(3)]) * 0.5]
    poses = np.array([TRUE_POSE.as_array(), *((TRUE_POSE @ step).as_array() for step in beside)])
    log_likelihoods = _log_likelihoods(settings, poses, _beams(_ranges(), settings))
    for step, likelihood in zip(beside, log_likelihoods[1:]):
        expect(
            log_likelihoods[0] > likelihood,
            f"{likelihood:.3g} at an offset of {step}, {log_likelihoods[0]:.3g} at the true pose",
        )


def leaves_inputs_unchanged(settings: LocalizerSettings) -> None:
    """It does not modify its inputs."""
    beams = _beams(_ranges(), settings)
    given = {"ranges": beams.ranges, "directions": beams.directions, "ends": beams.ends_xy}
    with expect_unchanged(map=GRID.cells, **given):
        _log_likelihoods(settings, _poses_nearby(), beams)


def follows_odometry(settings: LocalizerSettings) -> None:
    """The mean motion of the particles is that of the odometry, relative to each particle's heading."""
    before = Pose2(7.0, -3.0, 2.0)
    for yaw in (0.0, 1.5, -3.0):
        start = Pose2(1.0, 2.0, yaw)
        poses = np.tile(start.as_array(), (2000, 1))
        now = motion_model_of(settings).moved(poses, before, before @ MOTION_STEP, np.random.default_rng(0))
        expected = start @ MOTION_STEP
        off = np.hypot(*(now[:, :2].mean(axis=0) - (expected.x, expected.y)))
        expect(
            off <= MAX_POSITION_BIAS, f"{off:.2f} m off after {np.hypot(MOTION_STEP.x, MOTION_STEP.y):.2f} m"
        )
        turned = abs(np.mean([wrap(each - expected.yaw) for each in now[:, 2].tolist()]))
        expect(turned <= MAX_HEADING_BIAS, f"{turned:.2f} rad off after a turn of {MOTION_STEP.yaw:g} rad")


def _ranges() -> np.ndarray:
    return cast_rays(GRID, TRUE_POSE, ANGLES, RANGE_MAX)


def _beams(ranges: np.ndarray, settings: LocalizerSettings) -> Beams:
    scan = Scan(0.0, ANGLES[0], ANGLES[1] - ANGLES[0], ranges.astype(np.float32), 0.05, RANGE_MAX)
    return evenly_spaced_beams(scan, settings)


def _poses_nearby() -> np.ndarray:
    return TRUE_POSE.as_array() + np.random.default_rng(1).normal(0.0, 0.2, (50, 3))


def _log_likelihoods(settings: LocalizerSettings, poses: np.ndarray, beams: Beams) -> np.ndarray:
    return ScanLikelihood(GRID, settings).log_likelihoods(poses, beams, has_converged=False)


def _log_likelihoods_nearby(settings: LocalizerSettings) -> np.ndarray:
    return _log_likelihoods(settings, _poses_nearby(), _beams(_ranges(), settings))


def _moved(settings: LocalizerSettings) -> np.ndarray:
    given = _poses_nearby(), TRUE_POSE, TRUE_POSE @ MOTION_STEP
    return motion_model_of(settings).moved(*given, np.random.default_rng(3))


SENSOR_CHECKS = (
    gives_finite_log_likelihoods,
    prefers_true_pose,
    same_results(_log_likelihoods_nearby, "Equal calls return equal results."),
    leaves_inputs_unchanged,
)
MOTION_CHECKS = (
    follows_odometry,
    same_results(_moved, "All randomness comes from rng: equal seeds give equal results."),
)
CHECK_SUITES = {
    "sensor_model": suite(SENSOR, lambda name: LocalizerSettings(sensor_plugin=name), *SENSOR_CHECKS),
    "motion_model": suite(MOTION, lambda name: LocalizerSettings(motion_plugin=name), *MOTION_CHECKS),
}
# The tests of plugins generated by earlier versions import the old name.
__getattr__ = deprecated_names("amcl_lite.check", {"KITS": "CHECK_SUITES"})

if __name__ == "__main__":
    sys.exit(run_checks("amcl_lite", CHECK_SUITES))
