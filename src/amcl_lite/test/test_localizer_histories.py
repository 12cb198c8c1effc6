"""The Localizer under scans, odometry, poses, maps, settings and clocks, good and bad, in any order."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from amcl_lite import LocalizationError, Localizer, LocalizerSettings
from amcl_lite.config import InitialPose
from amcl_lite.localizer import is_valid_initial_pose
from planar import Pose2, Scan, grid_from_picture
from planar.geometry.limits import MAX_COORDINATE
from planar.geometry.ray_casting import cast_rays

ROOM_PICTURE = """
####################
#......#...........#
#......#...........#
#..................#
#..............##..#
#..............##..#
####...............#
#..................#
#..........#.......#
####################
"""


def grid_of(picture, origin=Pose2()):
    return grid_from_picture(picture, 0.05, origin, scale=4)


ROOM = grid_of(ROOM_PICTURE)
MAPS = {
    "room": ROOM,
    "room, elsewhere": grid_of(ROOM_PICTURE, Pose2(-300.0, 40.0, 2.0)),
    "hall": grid_of("######\n#....#\n#....#\n######"),
    "one cell": grid_from_picture("."),
    "nothing but walls": grid_of("##\n##"),
}
NOWHERE_FREE = ("nothing but walls",)
START = Pose2(1.0, 0.8, 0.3)
BEAMS, RANGE_MAX = 36, 5.0
COVARIANCES = {
    "usual": np.diag((0.04, 0.04, 0.02)),
    "none": np.zeros((3, 3)),
    "a line": np.array(((1.0, 1.0, 0.0), (1.0, 1.0, 0.0), (0.0, 0.0, 0.01))),
    "lopsided": np.array(((0.1, 5.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.1))),
    "negative": -np.eye(3),
    "huge": np.diag((MAX_COORDINATE, MAX_COORDINATE, MAX_COORDINATE)),
    "not a number": np.full((3, 3), math.nan),
    "without end": np.diag((math.inf, 1.0, 1.0)),
}
SENSELESS = ("not a number", "without end")
USUAL = LocalizerSettings(min_particles=50, max_particles=300, kld_error=0.05, resample_interval=1)
CHANGES = {
    "as at first": {},
    "more particles": {"min_particles": 400, "max_particles": 600},
    "one particle": {"min_particles": 1, "max_particles": 1},
    "drawn seldom": {"resample_interval": 4},
    "drawn when needed": {"selective_resampling": True},
    "products": {"sensor_model": "likelihood_field_prob", "beam_skip": True},
    "products without chance": {"sensor_model": "likelihood_field_prob", "z_rand": 0.0},
    "beams": {"sensor_model": "beam"},
    "blind": {"beams": 0},
    "deaf": {"z_hit": 0.0, "z_rand": 0.0},
    "omni": {"motion_model": "omni"},
    "right": {"motion_model": "diff-corrected"},
    "shaky": {"rotation_from_rotation": 10.0, "translation_from_translation": 10.0},
    "keen": {"update_when_still": 5.0},
    "as amcl": {"strict_compat": True},
}
GOOD_STEPS = 15


class LocalizerHistories(RuleBasedStateMachine):
    """What the node does with a Localizer; ``base_in_map``: the truth, in the room."""

    @initialize()
    def begin(self):
        self.base_in_map, self.base_in_odom = START, Pose2(5.0, -3.0, 1.0)
        self.now, self.map, self.settings = 100.0, "room", USUAL
        self.kept, self.rng = InitialPose(), np.random.default_rng(0)
        self.set_map("room")

    def set_map(self, name):
        """As SharedLocalizer does."""
        localizer = Localizer(MAPS[name], self.settings, self.rng)
        localizer.set_pose(self.kept.pose, self.kept.covariance)
        self.map, self.localizer = name, localizer

    def take(self, ranges, stamp=None, laser="laser"):
        """As the node does with a scan."""
        stamp = self.now if stamp is None else stamp
        scan = Scan(stamp, -math.pi, 2.0 * math.pi / BEAMS, ranges.astype(np.float32), 0.1, RANGE_MAX)
        estimate = self.localizer.update(self.base_in_odom, scan, laser)
        if estimate is not None:
            self.check(estimate)
        if estimate is not None and is_valid_initial_pose(estimate.base_in_map, estimate.covariance):
            variances = (float(estimate.covariance[i, i]) for i in range(3))
            pose = estimate.base_in_map
            self.kept = InitialPose(pose.x, pose.y, pose.yaw, *variances)

    def check(self, estimate):
        covariance = estimate.covariance
        assert estimate.base_in_map.is_finite()
        assert np.isfinite(covariance).all()
        assert (covariance == covariance.T).all()
        assert np.linalg.eigvalsh(covariance).min() >= -1e-9 * max(np.abs(covariance).max(), 1.0)

    def seen(self):
        angles = -math.pi + np.arange(BEAMS) * 2.0 * math.pi / BEAMS
        ranges = cast_rays(ROOM, self.base_in_map, angles, RANGE_MAX)
        return np.where(ranges >= RANGE_MAX, np.inf, ranges)

    def drive(self, step):
        self.base_in_map, self.base_in_odom = self.base_in_map @ step, self.base_in_odom @ step
        self.now += 0.2

    @rule(count=st.sampled_from((1, 1, 3, 8)), turn=st.sampled_from((0.4, -0.4)))
    def the_robot_drives(self, count, turn):
        for _ in range(count):
            ahead = self.base_in_map @ Pose2(0.25)
            is_free = ROOM.value_at(ahead.x, ahead.y) == 0
            self.drive(Pose2(0.1 * is_free, 0.0, turn))
            self.take(self.seen())

    @rule(laser=st.sampled_from(("laser", "other")), off=st.sampled_from((0.0, -3.0, -1e5, 4.0)))
    def a_scan_comes(self, laser, off):
        self.take(self.seen(), self.now + off, laser)

    @rule(
        value=st.sampled_from((math.nan, math.inf, -math.inf, 0.0, -1.0, 0.2, 3.0, 1e30)),
        count=st.sampled_from((0, 1, BEAMS, 400)),
        stretch=st.integers(1, 3),
    )
    def bad_scans_come(self, value, count, stretch):
        for _ in range(stretch):
            self.now += 0.2
            self.localizer.request_update()
            self.take(np.full(count, value))

    @rule(to=st.sampled_from((Pose2(), Pose2(7.0, 7.0, 0.0), Pose2(9e5, 9e5, 0.0), Pose2(-9e5, -9e5, 0.785))))
    def odometry_jumps(self, to):
        self.base_in_odom = to

    @rule(to=st.sampled_from((Pose2(math.nan, 0.0, 0.0), Pose2(0.0, math.inf, 0.0), Pose2(1e7, 0.0, 0.0))))
    def odometry_that_means_nothing_is_refused(self, to):
        before, was = self.localizer.particles, self.base_in_odom
        self.base_in_odom = to
        with pytest.raises(LocalizationError):
            self.take(self.seen())
        self.base_in_odom = was
        assert self.localizer.particles is before

    @rule()
    def carry_the_robot(self):
        self.base_in_map = Pose2(3.0, 0.5, -1.0) if self.base_in_map.x < 2.0 else START

    @rule(
        pose=st.sampled_from(
            ("right", Pose2(0.1, 0.1, 3.0), Pose2(-50.0, 60.0, 9000.0), Pose2(1e6, -1e6, 1.0))
        ),
        name=st.sampled_from(sorted(COVARIANCES)),
    )
    def set_the_pose(self, pose, name):
        pose, before = self.base_in_map if pose == "right" else pose, self.localizer.particles
        if name not in SENSELESS:
            self.localizer.set_pose(pose, COVARIANCES[name])
            return
        with pytest.raises(LocalizationError):
            self.localizer.set_pose(pose, COVARIANCES[name])
        assert self.localizer.particles is before

    @rule()
    def request_global_localization(self):
        self.localizer.start_global_localization()
        assert self.localizer.is_lost

    @rule(name=st.sampled_from(sorted(MAPS)))
    def another_map_comes(self, name):
        before = self.localizer
        try:
            self.set_map(name)
        except LocalizationError:
            assert name in NOWHERE_FREE
            assert self.localizer is before
        else:
            assert name not in NOWHERE_FREE

    @rule(name=st.sampled_from(sorted(CHANGES)))
    def settings_change(self, name):
        self.settings = replace(USUAL, **CHANGES[name])
        self.localizer.reconfigure(self.settings)

    @rule()
    def the_node_dies_and_comes_back(self):
        self.rng = np.random.default_rng(0)
        self.set_map(self.map)

    @rule()
    def resume_from_the_belief(self):
        belief = self.localizer.belief
        self.the_node_dies_and_comes_back()
        if belief is not None:
            self.localizer.restore(belief)

    @rule(seconds=st.sampled_from((5.0, 1e6, -5.0, -1e6)))
    def the_clock_jumps(self, seconds):
        self.now += seconds

    @invariant()
    def particles_are_a_distribution(self):
        particles = self.localizer.particles
        assert np.isfinite(particles.poses).all()
        assert (particles.weights >= 0.0).all()
        assert abs(particles.weights.sum() - 1.0) < 1e-9
        assert self.settings.min_particles <= particles.size <= self.settings.max_particles
        assert 1.0 - 1e-9 <= particles.effective_size <= particles.size + 1e-9

    @invariant()
    def estimates_are_finite(self):
        odom_in_map, quality = self.localizer.odom_in_map, self.localizer.quality
        assert odom_in_map is None or odom_in_map.is_finite()
        if quality is not None:
            assert 0.0 <= quality.probability <= 1.0
            assert 0.0 <= quality.explained <= 1.0
            assert 0.0 <= quality.through <= 1.0

    def teardown(self):
        """After any history, the robot is localized once its pose is set and no further faults occur."""
        if not hasattr(self, "localizer"):
            return
        if self.map != "room":
            self.set_map("room")
        self.settings = replace(USUAL, max_particles=500)
        self.localizer.reconfigure(self.settings)
        self.odometry_jumps(Pose2(2.0, 2.0, 1.0))
        self.localizer.set_pose(self.base_in_map, COVARIANCES["usual"])
        self.the_robot_drives(GOOD_STEPS, 0.4)
        found = self.localizer.odom_in_map @ self.base_in_odom
        assert found.distance_to(self.base_in_map) < 0.2
        assert not self.localizer.is_lost


LocalizerHistories.TestCase.settings = settings(
    max_examples=60, stateful_step_count=20, deadline=None, derandomize=True, database=None
)
TestLocalizerHistories = LocalizerHistories.TestCase
