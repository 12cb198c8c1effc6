"""Settings of localization: every parameter once, with its official name, default, bounds and meaning.

Names and defaults are those of amcl 1.17 (the defaults of its code, where its cfg file differs).
"""

import math
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, Dict, List

import numpy as np

from amcl_lite.motion.custom_model import CONTRACT as MOTION_MODEL
from amcl_lite.sensor.custom_model import CONTRACT as SENSOR_MODEL
from planar import Pose2
from planar.config.config_file import Section
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check

MOTION_MODELS = ("diff", "omni", "diff-corrected", "omni-corrected")
SENSOR_MODELS = ("likelihood_field", "likelihood_field_prob", "beam")
RESAMPLE_METHODS = ("systematic", "multinomial")
STRICT_COMPAT_SETTINGS: Dict[str, Any] = {
    "resample_method": "multinomial",
    "refine_pose": False,
    "recover_when_lost": False,
    "update_when_still": 0.0,
}


def _check_plugins(settings: "LocalizerSettings") -> None:
    for parameter_name, contract in (("motion_plugin", MOTION_MODEL), ("sensor_plugin", SENSOR_MODEL)):
        name = getattr(settings, parameter_name)
        if name:
            contract.load_required(name, parameter_name)


@dataclass(frozen=True)
class LocalizerSettings:
    """Parameters of the particle filter and its models; metres and radians."""

    min_particles: int = parameter(100, "smallest number of particles", bounds=Interval(1), dynamic=1000)
    max_particles: int = parameter(
        5000, "largest number of particles, and the number after a start", bounds=Interval(1), dynamic=10000
    )
    kld_error: float = parameter(
        0.01,
        "largest error between the true and the sampled distribution",
        bounds=Interval(1e-6, 1.0),
        name="kld_err",
        dynamic=1.0,
    )
    kld_z: float = parameter(
        0.99,
        "probability that the error is below kld_err; values from 1 on are the normal quantile",
        bounds=Interval(0.0),
        dynamic=1.0,
    )
    motion_model: str = parameter(
        "diff", "motion model of the odometry", name="odom_model_type", choices=MOTION_MODELS, dynamic=True
    )
    motion_plugin: str = parameter("", "user-defined model, package.module/Model, instead of odom_model_type")
    rotation_from_rotation: float = parameter(
        0.2, "rotation noise caused by rotation", bounds=Interval(0.0), name="odom_alpha1", dynamic=10.0
    )
    rotation_from_translation: float = parameter(
        0.2,
        "rotation noise caused by translation",
        "rad per m",
        Interval(0.0),
        name="odom_alpha2",
        dynamic=10.0,
    )
    translation_from_translation: float = parameter(
        0.2, "translation noise caused by translation", bounds=Interval(0.0), name="odom_alpha3", dynamic=10.0
    )
    translation_from_rotation: float = parameter(
        0.2,
        "translation noise caused by rotation",
        "m per rad",
        Interval(0.0),
        name="odom_alpha4",
        dynamic=10.0,
    )
    strafe_from_translation: float = parameter(
        0.2,
        "sideways noise caused by translation (omni models only)",
        bounds=Interval(0.0),
        name="odom_alpha5",
        dynamic=10.0,
    )
    sensor_model: str = parameter(
        "likelihood_field",
        "how scans are weighed",
        name="laser_model_type",
        choices=SENSOR_MODELS,
        dynamic=True,
    )
    sensor_plugin: str = parameter("", "your own model, package.module/Model, for laser_model_type")
    beams: int = parameter(
        30,
        "evenly spaced beams used of each scan; fewer than 2 disables the sensor",
        bounds=Interval(0),
        name="laser_max_beams",
        dynamic=250,
    )
    laser_min_range: float = parameter(
        -1.0, "readings up to this are ignored; -1: the scan's own limit", "m", Interval(-1.0), dynamic=1000.0
    )
    laser_max_range: float = parameter(
        -1.0,
        "readings from this on are ignored; -1: the scan's own limit",
        "m",
        Interval(-1.0),
        dynamic=1000.0,
    )
    z_hit: float = parameter(
        0.95,
        "share of beams that meet what the map shows",
        bounds=Interval(0.0, 1.0),
        name="laser_z_hit",
        dynamic=1.0,
    )
    z_short: float = parameter(
        0.1,
        "share of beams that are cut short (beam model)",
        bounds=Interval(0.0, 1.0),
        name="laser_z_short",
        dynamic=1.0,
    )
    z_max: float = parameter(
        0.05,
        "share of beams without return (beam model)",
        bounds=Interval(0.0, 1.0),
        name="laser_z_max",
        dynamic=1.0,
    )
    z_rand: float = parameter(
        0.05, "share of random readings", bounds=Interval(0.0, 1.0), name="laser_z_rand", dynamic=1.0
    )
    sigma_hit: float = parameter(
        0.2, "standard deviation of a hit", "m", Interval(1e-3), name="laser_sigma_hit", dynamic=10.0
    )
    lambda_short: float = parameter(
        0.1,
        "decay of short readings (beam model)",
        "1/m",
        Interval(0.0),
        name="laser_lambda_short",
        dynamic=10.0,
    )
    likelihood_max_distance: float = parameter(
        2.0,
        "distance to an obstacle at which the likelihood field is truncated",
        "m",
        Interval(0.0),
        name="laser_likelihood_max_dist",
        dynamic=20.0,
    )
    beam_skip: bool = parameter(
        False,
        "leave out beams that most particles cannot explain (likelihood_field_prob only)",
        name="do_beamskip",
        dynamic=True,
    )
    beam_skip_distance: float = parameter(
        0.5, "a beam that ends nearer than this to an obstacle is explained", "m", Interval(0.0), dynamic=2.0
    )
    beam_skip_threshold: float = parameter(
        0.3,
        "share of particles that must explain a beam for it to be used",
        bounds=Interval(0.0, 1.0),
        dynamic=1.0,
    )
    beam_skip_error_threshold: float = parameter(
        0.9, "if this share of beams would be left out, all are used", bounds=Interval(0.0, 1.0)
    )
    update_min_distance: float = parameter(
        0.2,
        "motion along x or along y of the odometry frame that causes an update",
        "m",
        Interval(0.0),
        name="update_min_d",
        dynamic=5.0,
    )
    update_min_angle: float = parameter(
        math.pi / 6.0,
        "rotation that causes an update",
        "rad",
        Interval(0.0),
        name="update_min_a",
        dynamic=2.0 * math.pi,
    )
    resample_interval: int = parameter(2, "filter updates per resampling", bounds=Interval(1), dynamic=20)
    selective_resampling: bool = parameter(
        False, "resample only if fewer than half the particles are effective"
    )
    recovery_alpha_slow: float = parameter(
        0.001, "decay of the slow average of weights; 0: no recovery", bounds=Interval(0.0, 1.0), dynamic=0.5
    )
    recovery_alpha_fast: float = parameter(
        0.1, "decay of the fast average of weights; 0: no recovery", bounds=Interval(0.0, 1.0), dynamic=1.0
    )

    resample_method: str = parameter(
        "systematic", "how particles are drawn by weight", choices=RESAMPLE_METHODS
    )
    refine_pose: bool = parameter(True, "improve the estimate and a tenth of the particles by scan matching")
    recover_when_lost: bool = parameter(True, "when scans do not fit the map, add particles where they do")
    update_when_still: float = parameter(
        0.05,
        "how often a robot that does not move is localized nevertheless; 0: never",
        "Hz",
        Interval(0.0),
        dynamic=10.0,
    )
    strict_compat: bool = parameter(
        False, "be amcl, mistakes included: kld_z is z, not a probability; the four above are off"
    )

    def __post_init__(self):
        check_parameters(self)
        if self.strict_compat:
            for name, value in STRICT_COMPAT_SETTINGS.items():
                object.__setattr__(self, name, value)
        _check_plugins(self)
        check(
            self.min_particles <= self.max_particles,
            "min_particles",
            f"at most max_particles ({self.max_particles})",
            self.min_particles,
        )

    @property
    def kld_quantile(self) -> float:
        """The z of KLD-sampling: the normal quantile of ``kld_z``; amcl uses ``kld_z`` itself as z."""
        if self.strict_compat or self.kld_z >= 1.0:
            return self.kld_z
        return NormalDist().inv_cdf(max(self.kld_z, 1e-9))


@dataclass(frozen=True)
class NodeSettings(LocalizerSettings):
    """Further parameters of the node."""

    odom_frame: str = parameter("odom", "frame of the odometry", name="odom_frame_id", dynamic=True)
    base_frame: str = parameter("base_link", "frame of the robot", name="base_frame_id", dynamic=True)
    map_frame: str = parameter("map", "frame of the map", name="global_frame_id", dynamic=True)
    use_map_topic: bool = parameter(
        False, "subscribe to the topic map instead of calling the service static_map", dynamic=True
    )
    first_map_only: bool = parameter(False, "ignore all but the first map on the topic", dynamic=True)
    gui_publish_rate: float = parameter(
        -1.0, "accepted, without effect (as in amcl)", bounds=Interval(-1.0), dynamic=100.0
    )
    save_pose_rate: float = parameter(
        0.5,
        "rate at which the pose is saved to the parameter server; 0 or less: never",
        "Hz",
        Interval(-1.0),
        dynamic=10.0,
    )
    transform_tolerance: float = parameter(
        0.1, "how far map->odom is post-dated", "s", Interval(0.0), dynamic=2.0
    )
    tf_broadcast: bool = parameter(True, "publish map->odom", dynamic=True)
    force_update_after_initialpose: bool = parameter(
        False, "update without motion after a pose on initialpose", dynamic=True
    )
    force_update_after_set_map: bool = parameter(
        False, "update without motion after a call of set_map", dynamic=True
    )
    std_warn_level_x: float = parameter(0.2, "diagnostics warn above this", "m", Interval(0.0))
    std_warn_level_y: float = parameter(0.2, "diagnostics warn above this", "m", Interval(0.0))
    std_warn_level_yaw: float = parameter(0.1, "diagnostics warn above this", "rad", Interval(0.0))
    bag_scan_period: float = parameter(-1.0, "pause between scans with --run-from-bag; -1: none", "s")
    seed: int = parameter(0, "seed of all random numbers; -1: from the operating system", bounds=Interval(-1))


@dataclass(frozen=True)
class InitialPose:
    """Initial pose and covariance; read for each new map, written when the pose is saved."""

    x: float = parameter(0.0, "initial pose, x", "m", name="initial_pose_x")
    y: float = parameter(0.0, "initial pose, y", "m", name="initial_pose_y")
    yaw: float = parameter(0.0, "initial pose, yaw", "rad", name="initial_pose_a")
    covariance_xx: float = parameter(
        0.25, "initial variance of x", "m^2", Interval(0.0), name="initial_cov_xx"
    )
    covariance_yy: float = parameter(
        0.25, "initial variance of y", "m^2", Interval(0.0), name="initial_cov_yy"
    )
    covariance_aa: float = parameter(
        (math.pi / 12.0) ** 2,
        "initial variance of yaw",
        "rad^2",
        Interval(0.0),
        name="initial_cov_aa",
    )

    def __post_init__(self):
        check_parameters(self)

    @property
    def pose(self) -> Pose2:
        return Pose2(self.x, self.y, self.yaw)

    @property
    def covariance(self) -> np.ndarray:
        """Diagonal covariance (3, 3) [m^2, rad^2]."""
        return np.diag((self.covariance_xx, self.covariance_yy, self.covariance_aa))


CONFIG_FILES = {
    "amcl_lite.yaml": Section(
        "",
        NodeSettings,
        InitialPose,
        about="All parameters of amcl_lite with their defaults: those of amcl, and additional ones.",
    )
}


def settings_warnings(settings: LocalizerSettings) -> List[str]:
    """Return warnings about settings with unexpected effects."""
    lines = []
    if settings.beams < 2:
        lines.append("laser_max_beams is below 2: scans are not used, the robot follows its odometry")
    if settings.recovery_alpha_slow > settings.recovery_alpha_fast:
        lines.append("recovery_alpha_slow above recovery_alpha_fast adds random poses when scans fit well")
    return lines
