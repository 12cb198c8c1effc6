import math
from dataclasses import replace

import numpy as np
import pytest

from amcl_lite import LocalizationError, Localizer, LocalizerSettings
from amcl_lite.belief import Belief, load_particles, save_particles
from amcl_lite.filter.particle_filter import ParticleFilter
from amcl_lite.filter.particles import equally_weighted
from amcl_lite.localizer import is_valid_initial_pose
from planar import OccupancyGrid, Pose2, Scan, grid_from_picture, wrap
from planar.geometry.limits import MAX_COORDINATE
from planar.geometry.ray_casting import cast_rays

HOME = """
##############################
#.........#..................#
#.........#..................#
#....................##......#
#....................##......#
#.........#..................#
#####..####..................#
#.........#######...##########
#.........#..................#
#.........#..................#
#..###.......................#
#..###....#.............##...#
#.........#.............##...#
##############################
"""
TURTLEBOT = LocalizerSettings(
    min_particles=500,
    max_particles=2000,
    kld_error=0.05,
    beams=60,
    z_hit=0.5,
    z_rand=0.5,
    update_min_distance=0.25,
    update_min_angle=0.2,
    resample_interval=1,
    recovery_alpha_slow=0.0,
    recovery_alpha_fast=0.0,
)
BEAMS, RANGE_MAX = 180, 8.0
START = Pose2(6.0, 4.0, math.pi)
CIRCLE = [Pose2(0.15, 0.0, 0.2)]


def home():
    return grid_from_picture(HOME, 0.05, scale=8)


def way(*legs):
    """Steps of 0.15 m or 0.15 rad that drive each leg's metres and then turn by its radians."""
    steps = []
    for metres, radians in legs:
        steps += [Pose2(0.15, 0.0, 0.0)] * round(metres / 0.15)
        steps += [Pose2(0.0, 0.0, math.copysign(0.15, radians))] * round(abs(radians) / 0.15)
    return steps


THROUGH_ALL_ROOMS = way(
    (3.6, 1.57), (2.0, 1.57), (0.9, -1.57), (0.6, 1.57), (4.8, 1.57), (0.6, -1.57), (2.0, 0.0)
)


class Toy:
    """A robot in the home whose odometry drifts; as a rule it slips 3 % and turns 1 degree a metre aside."""

    def __init__(self, base_in_map, seed=0, slip=0.03, aside=0.02, **scan_fields):
        self._slip, self._aside = slip, aside
        self.grid, self.base_in_map, self.base_in_odom = home(), base_in_map, Pose2(5.0, -3.0, 1.0)
        self._rng, self._fields = np.random.default_rng(seed), scan_fields
        self.stamp = 0.0

    def move(self, step):
        self.base_in_map = self.base_in_map @ step
        length = math.hypot(step.x, step.y)
        turn = self._aside * length + self._rng.normal(0.0, 0.01 * length + 0.02 * abs(step.yaw))
        self.base_in_odom = self.base_in_odom @ Pose2((1.0 - self._slip) * step.x, step.y, step.yaw + turn)

    def scan(self):
        self.stamp += 0.3
        angles = -math.pi + np.arange(BEAMS) * 2.0 * math.pi / BEAMS
        laser = Pose2(0.1, 0.0, 0.3)
        sign = -1.0 if self._fields.get("upside_down") else 1.0
        ranges = cast_rays(self.grid, self.base_in_map @ laser, sign * angles, RANGE_MAX)
        ranges = (ranges + self._rng.normal(0.0, 0.02, BEAMS)).astype(np.float32)
        ranges[ranges >= RANGE_MAX] = np.inf
        increment = 2.0 * math.pi / BEAMS
        return Scan(self.stamp, -math.pi, increment, ranges, 0.1, RANGE_MAX, laser, **self._fields)


def tracking_errors(toy, localizer, steps):
    """Errors of position and heading after each step, as a user of map->odom sees them: (N, 2)."""
    errors = []
    for step in steps:
        toy.move(step)
        localizer.update(toy.base_in_odom, toy.scan())
        found = localizer.odom_in_map @ toy.base_in_odom
        errors.append((found.distance_to(toy.base_in_map), abs(wrap(found.yaw - toy.base_in_map.yaw))))
    return np.array(errors)


def started(toy, settings=TURTLEBOT, seed=0):
    localizer = Localizer(toy.grid, settings, np.random.default_rng(seed))
    localizer.set_pose(toy.base_in_map, np.diag((0.04, 0.04, 0.02)))
    localizer.update(toy.base_in_odom, toy.scan())
    return localizer


@pytest.mark.parametrize("model", ["likelihood_field", "likelihood_field_prob", "beam"])
def test_a_robot_is_tracked_although_its_odometry_drifts(model):
    toy = Toy(START)
    settings = replace(TURTLEBOT, sensor_model=model)
    errors = tracking_errors(toy, started(toy, settings), THROUGH_ALL_ROOMS)
    # Half a cell of the picture's walls, and what odometry drifts between two updates.
    assert np.sqrt(np.mean(errors[:, 0] ** 2)) < 0.1 and errors[:, 0].max() < 0.25
    assert np.sqrt(np.mean(errors[:, 1] ** 2)) < 0.05


@pytest.mark.parametrize("model", ["likelihood_field", "beam"])
def test_a_robot_is_tracked_in_a_map_whose_origin_is_turned(model):
    corner = Pose2(4.0, -1.0, 2.2)
    toy = Toy(corner @ START)
    toy.grid = replace(home(), origin=corner @ home().origin)
    errors = tracking_errors(toy, started(toy, replace(TURTLEBOT, sensor_model=model)), THROUGH_ALL_ROOMS)
    assert errors[:, 0].max() < 0.25


def test_a_laser_that_hangs_upside_down_is_as_good():
    toy = Toy(START, upside_down=True)
    errors = tracking_errors(toy, started(toy), THROUGH_ALL_ROOMS)
    assert errors[:, 0].max() < 0.25


def test_a_wrong_start_is_pulled_in():
    toy = Toy(START)
    localizer = Localizer(toy.grid, TURTLEBOT, np.random.default_rng(0))
    localizer.set_pose(toy.base_in_map @ Pose2(0.5, 0.4, 0.3), np.diag((0.25, 0.25, 0.07)))
    localizer.update(toy.base_in_odom, toy.scan())
    assert tracking_errors(toy, localizer, THROUGH_ALL_ROOMS)[-1, 0] < 0.15


def test_a_localizer_resumes_with_the_saved_belief(tmp_path):
    """Also of two places, between which a mean would lie, and although the robot has driven on since."""
    toy = Toy(START)
    elsewhere = Pose2(2.0, 1.0, 0.4)
    poses = np.array([toy.base_in_map.as_array()] * 300 + [elsewhere.as_array()] * 300)
    save_particles(equally_weighted(poses), tmp_path / "kept")
    belief = Belief(load_particles(tmp_path / "kept"), toy.base_in_odom, Pose2(1.0, 2.0, 0.0), is_lost=True)
    for step in way((0.9, 0.6)):
        toy.move(step)
    localizer = Localizer(toy.grid, replace(TURTLEBOT, beams=0), np.random.default_rng(1))
    localizer.restore(belief)
    assert localizer.is_lost
    assert localizer.odom_in_map == belief.odom_in_map
    localizer.update(toy.base_in_odom, toy.scan())
    moved = belief.base_in_odom.inverse() @ toy.base_in_odom
    for place in (START, elsewhere):
        distances = np.hypot(*(localizer.particles.poses[:, :2] - (place @ moved).as_array()[:2]).T)
        assert np.mean(distances < 0.5) > 0.3


def test_a_kept_belief_is_that_of_the_last_update():
    toy = Toy(START)
    localizer = started(toy)
    where, odom_in_map = toy.base_in_odom, localizer.odom_in_map
    toy.move(Pose2(0.05, 0.0, 0.0))
    localizer.update(toy.base_in_odom, toy.scan())
    assert localizer.belief.base_in_odom == where
    assert localizer.belief.odom_in_map == odom_in_map
    assert localizer.belief.particles is localizer.particles
    localizer.start_global_localization()
    assert localizer.belief is None


@pytest.mark.parametrize(
    "table",
    [
        np.zeros((0, 4)),
        np.full((3, 4), 1.0 / 3.0, dtype=np.float32),
        np.full((3, 3), 1.0 / 3.0),
        np.full((3, 4), 1.0),
        np.array([[0.0, 0.0, 0.0, 1.5], [0.0, 0.0, 0.0, -0.5]]),
        np.array([[math.nan, 0.0, 0.0, 1.0]]),
        np.array([[1e30, 0.0, 0.0, 1.0]]),
        np.array([[0.0, 0.0, 0.0, math.nan]]),
    ],
)
def test_a_file_of_no_particles_is_named(tmp_path, table):
    np.save(tmp_path / "kept.npy", table)
    with pytest.raises(LocalizationError, match=r"kept\.npy"):
        load_particles(tmp_path / "kept.npy")


def test_a_file_that_is_none_is_named(tmp_path):
    (tmp_path / "kept").write_bytes(b"nothing")
    for name in ("kept", "not there"):
        with pytest.raises(LocalizationError, match=name):
            load_particles(tmp_path / name)


def test_a_scattered_filter_finds_the_robot():
    toy = Toy(Pose2(7.0, 0.8, 0.5))
    localizer = Localizer(toy.grid, LocalizerSettings(beams=60), np.random.default_rng(0))
    localizer.start_global_localization()
    localizer.update(toy.base_in_odom, toy.scan())
    assert tracking_errors(toy, localizer, CIRCLE * 120)[-1, 0] < 0.25


def test_a_kidnapped_robot_knows_that_it_is_lost_and_is_found_again():
    toy = Toy(START)
    localizer = started(toy)
    assert tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[:30])[-1, 0] < 0.1
    assert not localizer.is_lost
    toy.base_in_map = Pose2(8.0, 2.0, math.pi)
    tracking_errors(toy, localizer, way((1.5, 0.0)))
    assert localizer.is_lost
    back_and_forth = way((1.5, 3.14), (3.0, 3.14), (3.0, 3.14))
    assert tracking_errors(toy, localizer, back_and_forth)[-20:, 0].max() < 0.1
    assert not localizer.is_lost


def test_a_robot_that_is_carried_away_while_it_stands_finds_itself_without_a_motion():
    toy = Toy(START)
    localizer = started(toy)
    tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[:30])
    toy.base_in_map = toy.base_in_map @ Pose2(0.0, 0.5)
    updates = localizer.updates
    errors = tracking_errors(toy, localizer, [Pose2()] * 40)
    assert errors[0, 0] > 0.4
    assert errors[-1, 0] < 0.1
    assert localizer.updates > updates
    settled = localizer.updates
    tracking_errors(toy, localizer, [Pose2()] * 10)
    assert localizer.updates == settled, "scans that fit are not worked in while the robot stands"


@pytest.mark.parametrize("length", [1.05, 1.95])
@pytest.mark.parametrize("seed", range(3))
def test_a_robot_whose_scans_are_metres_apart_is_tracked_with_the_defaults(length, seed):
    """The default noise grows with the square of the step."""
    toy = Toy(START, seed)
    localizer = started(toy, LocalizerSettings(), seed)
    per_scan, errors = round(length / 0.15), []
    for i, step in enumerate(THROUGH_ALL_ROOMS, 1):
        if i % per_scan == 0:
            toy.stamp += 2.0
            errors.append(tracking_errors(toy, localizer, [step])[0, 0])
        else:
            toy.move(step)
    assert max(errors) < 0.5


def test_without_recovery_a_kidnapped_robot_stays_lost():
    toy = Toy(START)
    localizer = started(toy, replace(TURTLEBOT, recover_when_lost=False))
    toy.base_in_map = Pose2(8.0, 2.0, math.pi)
    assert tracking_errors(toy, localizer, way((3.0, 3.14), (3.0, 3.14)))[-1, 0] > 1.0
    assert localizer.is_lost


def test_scan_matching_makes_the_estimate_better():
    errors = []
    for refine_pose in (False, True):
        toy = Toy(START)
        localizer = started(toy, replace(TURTLEBOT, refine_pose=refine_pose))
        errors.append(tracking_errors(toy, localizer, THROUGH_ALL_ROOMS)[:, 0].mean())
    assert errors[1] < 0.5 * errors[0]


def test_a_change_of_settings_goes_on_from_the_estimate():
    toy = Toy(START)
    localizer = started(toy)
    tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[:20])
    localizer.reconfigure(replace(TURTLEBOT, sensor_model="likelihood_field_prob", max_particles=1000))
    assert localizer.particles.size == 1000
    assert tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[20:])[:, 0].max() < 0.15


def test_a_motion_just_after_new_settings_is_not_lost():
    toy = Toy(START)
    localizer = started(toy)
    localizer.reconfigure(replace(TURTLEBOT, max_particles=1000, refine_pose=False))
    assert tracking_errors(toy, localizer, [Pose2(0.0, 0.0, 0.5)])[0, 1] < 0.1


def test_new_settings_before_the_first_scan_hold_for_the_particles_at_once():
    localizer = Localizer(home(), TURTLEBOT, np.random.default_rng(0))
    for count in (600, 3000):
        localizer.reconfigure(replace(TURTLEBOT, max_particles=count))
        assert localizer.particles.size == count


def test_a_pose_set_since_the_last_estimate_survives_new_settings():
    toy = Toy(START)
    localizer = started(toy)
    localizer.set_pose(Pose2(2.0, 1.0), np.diag((0.01, 0.01, 0.01)))
    localizer.reconfigure(replace(TURTLEBOT, max_particles=1000))
    assert np.allclose(localizer.particles.poses.mean(axis=0), (2.0, 1.0, 0.0), atol=0.05)
    localizer.start_global_localization()
    localizer.reconfigure(TURTLEBOT)
    assert localizer.is_lost
    assert np.std(localizer.particles.poses[:, 0]) > 1.0


def test_odometry_that_jumps_beyond_all_measure_leaves_the_robot_within_reach():
    toy = Toy(START)
    localizer = started(toy)
    toy.base_in_odom = Pose2(-9e5, 9e5, 0.8)
    estimate = localizer.update(toy.base_in_odom, toy.scan())
    assert np.abs(localizer.particles.poses[:, :2]).max() <= MAX_COORDINATE
    assert not is_valid_initial_pose(estimate.base_in_map, estimate.covariance)
    localizer.reconfigure(replace(TURTLEBOT, max_particles=1000))
    assert np.abs(localizer.particles.poses[:, :2]).max() <= MAX_COORDINATE
    localizer.set_pose(toy.base_in_map, np.diag((0.04, 0.04, 0.02)))
    assert tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[:20])[:, 0].max() < 0.15


@pytest.mark.parametrize("seed", range(3))
def test_an_odometry_bias_of_ten_percent_is_followed(seed):
    toy = Toy(START, seed, slip=0.1, aside=0.04)
    assert tracking_errors(toy, started(toy, seed=seed), THROUGH_ALL_ROOMS)[:, 0].max() < 0.2


def test_scans_that_contradict_each_other_leave_the_weights_a_distribution():
    particle_filter = ParticleFilter(equally_weighted(np.zeros((2, 3))), np.random.default_rng(0))
    for log_likelihoods in ((0.0, -1000.0), (-1000.0, 0.0)):  # no particle is likely by both
        particle_filter.weigh(np.array(log_likelihoods), TURTLEBOT)
        assert particle_filter.particles.weights.tolist() == [1.0, 0.0]


def test_furniture_that_is_not_on_the_map_does_no_harm():
    toy = Toy(START)
    localizer = started(toy)
    cells = toy.grid.cells.copy()
    for x, y in ((7.0, 4.6), (3.2, 4.7), (1.0, 3.4), (0.6, 2.0), (6.0, 0.5), (7.5, 2.1), (5.2, 2.0)):
        cells[round(y / 0.05) : round((y + 0.5) / 0.05), round(x / 0.05) : round((x + 0.6) / 0.05)] = 100
    toy.grid = OccupancyGrid(cells, 0.05)
    errors = tracking_errors(toy, localizer, THROUGH_ALL_ROOMS)
    assert errors[:, 0].max() < 0.2
    assert not localizer.is_lost


def test_a_start_that_is_wrong_by_metres_is_found_out():
    toy = Toy(START)
    localizer = Localizer(toy.grid, TURTLEBOT, np.random.default_rng(0))
    localizer.set_pose(toy.base_in_map @ Pose2(-2.5, 1.5, 1.0), np.diag((0.25, 0.25, 0.07)))
    localizer.update(toy.base_in_odom, toy.scan())
    back_and_forth = way((1.5, 3.14), (3.0, 3.14), (3.0, 3.14))
    assert tracking_errors(toy, localizer, back_and_forth)[-20:, 0].max() < 0.1
    assert not localizer.is_lost


def test_a_map_that_is_warped_and_lies_elsewhere_will_do():
    toy = Toy(START)
    stretch, corner = 1.01, Pose2(-7.0, 12.0, 0.0)
    map_of_home = OccupancyGrid(toy.grid.cells, stretch * toy.grid.resolution, corner)

    def in_map(pose):
        return corner @ Pose2(stretch * pose.x, stretch * pose.y, pose.yaw)

    localizer = Localizer(map_of_home, TURTLEBOT, np.random.default_rng(0))
    localizer.set_pose(in_map(toy.base_in_map), np.diag((0.04, 0.04, 0.02)))
    for step in THROUGH_ALL_ROOMS:
        toy.move(step)
        localizer.update(toy.base_in_odom, toy.scan())
        found = localizer.odom_in_map @ toy.base_in_odom
        # A hundredth of the longest beam, and what odometry drifts between two updates.
        assert found.distance_to(in_map(toy.base_in_map)) < 0.2
        assert not localizer.is_lost


def test_nothing_is_done_while_the_robot_stands():
    toy = Toy(START)
    localizer = started(toy)
    before = localizer.particles
    toy.move(Pose2(0.2, 0.0, 0.1))
    assert localizer.update(toy.base_in_odom, toy.scan()) is None
    assert localizer.particles is before
    toy.move(Pose2(0.2, 0.0, 0.0))
    assert localizer.update(toy.base_in_odom, toy.scan()) is not None


def test_distance_counts_along_each_axis_of_odometry_not_as_the_crow_flies():
    toy = Toy(START)
    localizer = started(toy)
    aside = Pose2(toy.base_in_odom.x + 0.24, toy.base_in_odom.y + 0.24, toy.base_in_odom.yaw)
    assert localizer.update(aside, toy.scan()) is None


def test_an_update_can_be_asked_for():
    toy = Toy(START)
    localizer = started(toy)
    localizer.request_update()
    assert localizer.update(toy.base_in_odom, toy.scan()) is not None
    assert localizer.update(toy.base_in_odom, toy.scan()) is None


def test_an_estimate_is_given_only_when_the_filter_was_resampled():
    toy = Toy(START)
    localizer = started(toy, replace(TURTLEBOT, resample_interval=3))
    given = []
    for _ in range(5):
        toy.move(Pose2(0.3, 0.0, 0.3))
        given.append(localizer.update(toy.base_in_odom, toy.scan()) is not None)
    assert given == [False, True, False, False, True]


def test_each_of_two_lasers_counts_once_per_motion():
    toy = Toy(START)
    localizer = started(toy)
    toy.move(Pose2(0.3, 0.0, 0.0))
    asked = [localizer.update(toy.base_in_odom, toy.scan(), laser) for laser in ("a", "b", "a", "b")]
    assert [estimate is not None for estimate in asked] == [True, True, False, False]


def test_fewer_than_two_beams_leave_the_weights_alone():
    toy = Toy(START)
    localizer = started(toy, LocalizerSettings(beams=1))
    assert np.ptp(localizer.particles.weights) == 0.0


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.0, -1.0, 1e9])
def test_a_scan_without_a_valid_beam_changes_no_weight(value):
    toy = Toy(START)
    localizer = Localizer(toy.grid, LocalizerSettings(), np.random.default_rng(0))
    blind = Scan(0.0, -1.0, 0.1, np.full(20, value, dtype=np.float32), 0.1, RANGE_MAX)
    estimate = localizer.update(toy.base_in_odom, blind)
    assert estimate.base_in_map.is_finite() and np.isfinite(estimate.covariance).all()
    assert np.ptp(localizer.particles.weights) < 1e-15


def test_an_empty_scan_does_no_harm():
    localizer = Localizer(home(), LocalizerSettings(), np.random.default_rng(0))
    empty = Scan(0.0, -1.0, 0.1, np.zeros(0, dtype=np.float32), 0.1, RANGE_MAX)
    assert localizer.update(Pose2(), empty).base_in_map.is_finite()


def test_odometry_that_is_not_finite_is_refused():
    toy = Toy(START)
    with pytest.raises(LocalizationError, match="odometry"):
        started(toy).update(Pose2(math.nan, 0.0, 0.0), toy.scan())


def test_a_start_that_is_not_finite_is_refused():
    localizer = Localizer(home(), LocalizerSettings(), np.random.default_rng(0))
    with pytest.raises(LocalizationError, match="finite"):
        localizer.set_pose(Pose2(math.inf, 0.0, 0.0), np.eye(3))


def test_a_seed_settles_everything():
    ends = []
    for _ in range(2):
        toy = Toy(START)
        localizer = started(toy, seed=5)
        tracking_errors(toy, localizer, THROUGH_ALL_ROOMS[:30])
        ends.append(localizer.particles.poses.tobytes())
    assert ends[0] == ends[1]


def test_a_robot_that_stands_is_localized_again_if_asked_for_by_rate():
    toy = Toy(START)
    still = [Pose2()] * 10  # 0.3 s each
    for rate, updates in ((0.0, 0), (1.0, 2)):
        localizer = started(toy, replace(TURTLEBOT, update_when_still=rate))
        before = localizer.updates
        tracking_errors(toy, localizer, still)
        assert localizer.updates - before == updates


def test_the_estimate_of_a_standing_robot_does_not_follow_the_bias_of_its_odometry():
    """The motion thresholds alone let the estimate drift by update_min_angle before the next update."""
    toy, bias = Toy(START), 5e-4  # [rad/s]
    localizer, errors = started(toy), []
    for _ in range(300):
        toy.stamp += 4.7  # and 0.3 of the scan: 25 minutes
        toy.base_in_odom = toy.base_in_odom @ Pose2(0.0, 0.0, 5.0 * bias)
        errors.append(tracking_errors(toy, localizer, [Pose2()])[0])
    distances, angles = np.array(errors).max(axis=0)
    assert distances < 0.05
    assert math.degrees(angles) < 1.0
