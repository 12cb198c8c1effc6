"""Settings of localization: every parameter once, with its official name, default, bounds and meaning.

Names and defaults are those of amcl 1.17 (the defaults of its code, where its cfg file differs).
"""

import dataclasses
import math
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, Dict, List, Tuple

import numpy as np

from planar import Pose2
from planar.config.settings import check, check_parameters, parameter

MOTION_MODELS = ("diff", "omni", "diff-corrected", "omni-corrected")
SENSOR_MODELS = ("likelihood_field", "likelihood_field_prob", "beam")
RESAMPLE_METHODS = ("systematic", "multinomial")
AS_AMCL: Dict[str, Any] = {
    "resample_method": "multinomial",
    "refine_pose": False,
    "recover_when_lost": False,
    "update_when_still": 0.0,
}


@dataclass(frozen=True)
class LocalizerSettings:
    """What the particle filter works with; metres and radians."""

    min_particles: int = parameter(
        "min_particles", 100, "fewest particles (KLD-sampling's floor)", 1, dynamic=1000
    )
    max_particles: int = parameter(
        "max_particles", 5000, "most particles, and how many a new start is made of", 1, dynamic=10000
    )
    kld_error: float = parameter(
        "kld_err", 0.01, "largest error between the true and the sampled distribution", 1e-6, 1.0, dynamic=1.0
    )
    kld_z: float = parameter(
        "kld_z",
        0.99,
        "probability of an error below kld_err; from 1 on: its normal quantile",
        0.0,
        dynamic=1.0,
    )
    motion_model: str = parameter(
        "odom_model_type", "diff", "how odometry errs", choices=MOTION_MODELS, dynamic=True
    )
    rotation_from_rotation: float = parameter(
        "odom_alpha1", 0.2, "rotation noise caused by rotation", 0.0, dynamic=10.0
    )
    rotation_from_translation: float = parameter(
        "odom_alpha2", 0.2, "rotation noise caused by translation, rad per m", 0.0, dynamic=10.0
    )
    translation_from_translation: float = parameter(
        "odom_alpha3", 0.2, "translation noise caused by translation", 0.0, dynamic=10.0
    )
    translation_from_rotation: float = parameter(
        "odom_alpha4", 0.2, "translation noise caused by rotation, m per rad", 0.0, dynamic=10.0
    )
    strafe_from_translation: float = parameter(
        "odom_alpha5", 0.2, "sideways noise caused by translation (omni models only)", 0.0, dynamic=10.0
    )
    sensor_model: str = parameter(
        "laser_model_type", "likelihood_field", "how scans are weighed", choices=SENSOR_MODELS, dynamic=True
    )
    beams: int = parameter(
        "laser_max_beams",
        30,
        "evenly spaced beams used of each scan; fewer than 2 disables the sensor",
        0,
        dynamic=250,
    )
    laser_min_range: float = parameter(
        "laser_min_range",
        -1.0,
        "readings up to this, m, are ignored; -1: the scan's own limit",
        -1.0,
        dynamic=1000.0,
    )
    laser_max_range: float = parameter(
        "laser_max_range",
        -1.0,
        "readings from this on, m, are ignored; -1: the scan's own limit",
        -1.0,
        dynamic=1000.0,
    )
    z_hit: float = parameter(
        "laser_z_hit", 0.95, "share of beams that meet what the map shows", 0.0, 1.0, dynamic=1.0
    )
    z_short: float = parameter(
        "laser_z_short", 0.1, "share of beams that are cut short (beam model)", 0.0, 1.0, dynamic=1.0
    )
    z_max: float = parameter(
        "laser_z_max", 0.05, "share of beams without return (beam model)", 0.0, 1.0, dynamic=1.0
    )
    z_rand: float = parameter("laser_z_rand", 0.05, "share of random readings", 0.0, 1.0, dynamic=1.0)
    sigma_hit: float = parameter("laser_sigma_hit", 0.2, "standard deviation of a hit, m", 1e-3, dynamic=10.0)
    lambda_short: float = parameter(
        "laser_lambda_short", 0.1, "decay of short readings (beam model), 1/m", 0.0, dynamic=10.0
    )
    likelihood_max_distance: float = parameter(
        "laser_likelihood_max_dist",
        2.0,
        "largest distance to an obstacle that is told apart, m",
        0.0,
        dynamic=20.0,
    )
    beam_skip: bool = parameter(
        "do_beamskip",
        False,
        "leave out beams that most particles cannot explain (likelihood_field_prob only)",
        dynamic=True,
    )
    beam_skip_distance: float = parameter(
        "beam_skip_distance",
        0.5,
        "a beam that ends nearer than this to an obstacle is explained, m",
        0.0,
        dynamic=2.0,
    )
    beam_skip_threshold: float = parameter(
        "beam_skip_threshold",
        0.3,
        "share of particles that must explain a beam for it to be used",
        0.0,
        1.0,
        dynamic=1.0,
    )
    beam_skip_error_threshold: float = parameter(
        "beam_skip_error_threshold", 0.9, "if this share of beams would be left out, all are used", 0.0, 1.0
    )
    update_min_distance: float = parameter(
        "update_min_d",
        0.2,
        "motion along x or along y of the odometry frame that causes an update, m",
        0.0,
        dynamic=5.0,
    )
    update_min_angle: float = parameter(
        "update_min_a", math.pi / 6.0, "rotation that causes an update, rad", 0.0, dynamic=2.0 * math.pi
    )
    resample_interval: int = parameter("resample_interval", 2, "filter updates per resampling", 1, dynamic=20)
    selective_resampling: bool = parameter(
        "selective_resampling", False, "resample only if fewer than half the particles are effective"
    )
    recovery_alpha_slow: float = parameter(
        "recovery_alpha_slow",
        0.001,
        "decay of the slow average of weights; 0: no recovery",
        0.0,
        1.0,
        dynamic=0.5,
    )
    recovery_alpha_fast: float = parameter(
        "recovery_alpha_fast",
        0.1,
        "decay of the fast average of weights; 0: no recovery",
        0.0,
        1.0,
        dynamic=1.0,
    )

    resample_method: str = parameter(
        "resample_method", "systematic", "how particles are drawn by weight", choices=RESAMPLE_METHODS
    )
    refine_pose: bool = parameter(
        "refine_pose", True, "improve the estimate, not the particles, by scan matching"
    )
    recover_when_lost: bool = parameter(
        "recover_when_lost", True, "when scans do not fit the map, add particles where they do"
    )
    update_when_still: float = parameter(
        "update_when_still",
        0.0,
        "how often a robot that does not move is localized nevertheless, Hz; 0: never",
        0.0,
        dynamic=10.0,
    )
    strict_compat: bool = parameter(
        "strict_compat",
        False,
        "be amcl, mistakes included: kld_z is z, not a probability; the four above are off",
    )

    def __post_init__(self):
        check_parameters(self)
        if self.strict_compat:
            for name, value in AS_AMCL.items():
                object.__setattr__(self, name, value)
        check(
            self.min_particles <= self.max_particles,
            "min_particles",
            f"at most max_particles ({self.max_particles})",
            self.min_particles,
        )

    @property
    def kld_quantile(self) -> float:
        """The z of KLD-sampling: the normal quantile of ``kld_z``; amcl takes ``kld_z`` itself for z."""
        if self.strict_compat or self.kld_z >= 1.0:
            return self.kld_z
        return NormalDist().inv_cdf(max(self.kld_z, 1e-9))


@dataclass(frozen=True)
class NodeSettings(LocalizerSettings):
    """What the node needs besides."""

    odom_frame: str = parameter("odom_frame_id", "odom", "frame of the odometry", dynamic=True)
    base_frame: str = parameter("base_frame_id", "base_link", "frame of the robot", dynamic=True)
    map_frame: str = parameter("global_frame_id", "map", "frame of the map", dynamic=True)
    use_map_topic: bool = parameter(
        "use_map_topic",
        False,
        "take the map from the topic map, not from the service static_map",
        dynamic=True,
    )
    first_map_only: bool = parameter(
        "first_map_only", False, "ignore all but the first map on the topic", dynamic=True
    )
    gui_publish_rate: float = parameter(
        "gui_publish_rate", -1.0, "accepted, without effect (as in amcl)", -1.0, dynamic=100.0
    )
    save_pose_rate: float = parameter(
        "save_pose_rate",
        0.5,
        "how often the pose goes to the parameter server, Hz; 0 or less: never",
        -1.0,
        dynamic=10.0,
    )
    transform_tolerance: float = parameter(
        "transform_tolerance", 0.1, "how far map->odom is post-dated, s", 0.0, dynamic=2.0
    )
    tf_broadcast: bool = parameter("tf_broadcast", True, "publish map->odom", dynamic=True)
    force_update_after_initialpose: bool = parameter(
        "force_update_after_initialpose",
        False,
        "update without motion after a pose on initialpose",
        dynamic=True,
    )
    force_update_after_set_map: bool = parameter(
        "force_update_after_set_map", False, "update without motion after a call of set_map", dynamic=True
    )
    std_warn_level_x: float = parameter("std_warn_level_x", 0.2, "diagnostics warn above this, m", 0.0)
    std_warn_level_y: float = parameter("std_warn_level_y", 0.2, "diagnostics warn above this, m", 0.0)
    std_warn_level_yaw: float = parameter("std_warn_level_yaw", 0.1, "diagnostics warn above this, rad", 0.0)
    bag_scan_period: float = parameter(
        "bag_scan_period", -1.0, "pause between scans with --run-from-bag, s; -1: none"
    )
    seed: int = parameter(
        "seed", 0, "of all chance; the same seed gives the same draws; -1: from the system", -1
    )


@dataclass(frozen=True)
class InitialPose:
    """Where a filter starts when a map arrives; read anew at each map, written by pose saving."""

    x: float = parameter("initial_pose_x", 0.0, "m")
    y: float = parameter("initial_pose_y", 0.0, "m")
    yaw: float = parameter("initial_pose_a", 0.0, "rad")
    covariance_xx: float = parameter("initial_cov_xx", 0.25, "m^2", 0.0)
    covariance_yy: float = parameter("initial_cov_yy", 0.25, "m^2", 0.0)
    covariance_aa: float = parameter("initial_cov_aa", (math.pi / 12.0) ** 2, "rad^2", 0.0)

    def __post_init__(self):
        check_parameters(self)

    @property
    def pose(self) -> Pose2:
        return Pose2(self.x, self.y, self.yaw)

    @property
    def covariance(self) -> np.ndarray:
        """(3, 3), diagonal."""
        return np.diag((self.covariance_xx, self.covariance_yy, self.covariance_aa))


def defaults() -> Dict[str, Tuple[Any, str]]:
    """Every parameter of the node by its official name: default and meaning."""
    return {
        field.metadata["name"]: (field.default, ": ".join((field.metadata["meaning"], *_choices(field))))
        for kind in (NodeSettings, InitialPose)
        for field in dataclasses.fields(kind)
    }


def as_yaml() -> str:
    """All parameters with defaults and meanings, as the text of a YAML file."""
    lines = ["# Every parameter of amcl_lite with its default: the official amcl's, and a few of its own."]
    for name, (default, meaning) in defaults().items():
        value = str(default).lower() if isinstance(default, bool) else default
        lines.append(f"{name}: {value}  # {meaning}")
    return "\n".join(lines) + "\n"


def advice(settings: LocalizerSettings) -> List[str]:
    """What a user may not expect of these settings, in sentences."""
    lines = []
    if settings.beams < 2:
        lines.append("laser_max_beams is below 2: scans are not used, the robot follows its odometry")
    if settings.beam_skip and settings.sensor_model != "likelihood_field_prob":
        lines.append("do_beamskip has no effect unless laser_model_type is likelihood_field_prob")
    if (settings.recovery_alpha_slow == 0.0) != (settings.recovery_alpha_fast == 0.0):
        lines.append("recovery_alpha_slow and recovery_alpha_fast must both be above 0 to have an effect")
    if settings.recovery_alpha_slow > settings.recovery_alpha_fast:
        lines.append("recovery_alpha_slow above recovery_alpha_fast adds random poses when scans fit well")
    return lines


def _choices(field) -> List[str]:
    return [", ".join(field.metadata["choices"])] if field.metadata["choices"] else []
