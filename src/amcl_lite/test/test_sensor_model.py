"""Weights of the sensor models are those of the formulas, computed by hand on tiny maps."""

import math

import numpy as np
import pytest

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.sensor.beams import Beams, evenly_spaced_beams
from amcl_lite.sensor.likelihood_field import likelihood_field
from amcl_lite.sensor.sensor_model import log_beam_model, log_likelihood_field, log_likelihood_field_prob
from planar import Pose2, Scan, grid_from_picture

CORRIDOR = grid_from_picture("#######\n......#\n#######", origin=Pose2(0.0, -1.5, 0.0))
SETTINGS = LocalizerSettings(z_hit=0.8, z_rand=0.2, sigma_hit=0.5, z_short=0.1, z_max=0.05, lambda_short=0.3)
MAX_RANGE = 8.0
HERE = np.array([[1.5, 0.0, 0.0]])


def scan(ranges, angle_min=0.0, angle_increment=0.01, **fields):
    ranges = np.asarray(ranges, dtype=np.float32)
    return Scan(0.0, angle_min, angle_increment, ranges, 0.1, MAX_RANGE, **fields)


def beams(*ranges, start_xy=(0.0, 0.0)):
    return Beams(np.array(ranges, dtype=float), np.zeros(len(ranges)), MAX_RANGE, np.array(start_xy))


def field():
    return likelihood_field(CORRIDOR, SETTINGS.sigma_hit, SETTINGS.likelihood_max_distance)


def p_hit(distance):
    return 0.8 * math.exp(-0.5 * (distance / 0.5) ** 2) + 0.2 / MAX_RANGE


def test_the_field_is_one_on_a_wall_and_falls_off_with_distance():
    fit = field().fit
    assert fit[2, 7] == 1.0 and fit[2, 6] == pytest.approx(math.exp(-2.0))
    assert field().value_at_distance(0.5) == pytest.approx(math.exp(-0.5))


def test_likelihood_field_weighs_by_one_and_the_sum_of_cubes():
    weight = log_likelihood_field(HERE, beams(5.0, 4.0), field(), SETTINGS)
    assert weight[0] == pytest.approx(math.log(1.0 + p_hit(0.0) ** 3 + p_hit(1.0) ** 3))


def test_likelihood_field_prob_weighs_by_the_product():
    weight = log_likelihood_field_prob(HERE, beams(5.0, 4.0), field(), SETTINGS, skip_beams=False)
    assert weight[0] == pytest.approx(math.log(p_hit(0.0) * p_hit(1.0)))


def test_an_end_outside_the_map_counts_as_far_from_everything():
    weight = log_likelihood_field_prob(HERE, beams(6.5), field(), SETTINGS, skip_beams=False)
    assert weight[0] == pytest.approx(math.log(p_hit(SETTINGS.likelihood_max_distance)), rel=1e-6)


def test_beams_without_return_do_not_change_the_likelihood_field():
    assert log_likelihood_field(HERE, beams(MAX_RANGE, MAX_RANGE), field(), SETTINGS)[0] == 0.0


def test_the_laser_need_not_sit_in_the_middle_of_the_robot():
    ahead = log_likelihood_field(HERE, beams(4.0, start_xy=(1.0, 0.0)), field(), SETTINGS)
    assert ahead[0] == pytest.approx(math.log(1.0 + p_hit(0.0) ** 3))


def test_a_map_may_be_turned():
    turned = grid_from_picture("#######\n......#\n#######", origin=Pose2(1.5, 0.0, math.pi / 2))
    there = np.array([[0.0, 1.5, math.pi / 2]])
    weights = log_likelihood_field(there, beams(5.0), likelihood_field(turned, 0.5, 2.0), SETTINGS)
    assert weights[0] == pytest.approx(math.log(1.0 + p_hit(0.0) ** 3))


def test_skipped_beams_are_those_that_most_particles_cannot_explain():
    poses = np.array([[1.5, 0.0, 0.0], [1.6, 0.0, 0.0], [1.4, 0.0, 0.0], [1.5, 0.0, 0.0]])
    person = 2.0
    skipping = log_likelihood_field_prob(poses, beams(5.0, person, 5.0), field(), SETTINGS, skip_beams=True)
    without = log_likelihood_field_prob(poses, beams(5.0, 5.0), field(), SETTINGS, skip_beams=False)
    assert skipping == pytest.approx(without)


def test_no_beam_is_skipped_when_nearly_all_would_be():
    lost = beams(2.0, 2.0, 2.0)
    skipping = log_likelihood_field_prob(HERE, lost, field(), SETTINGS, skip_beams=True)
    assert skipping == pytest.approx(
        log_likelihood_field_prob(HERE, lost, field(), SETTINGS, skip_beams=False)
    )


def test_the_beam_model_sums_its_four_parts():
    expected_range = 4.5
    short, exact, none = 3.0, expected_range, MAX_RANGE
    p_short = 0.8 * math.exp(-0.5 * (1.5 / 0.5) ** 2) + 0.1 * 0.3 * math.exp(-0.3 * 3.0) + 0.2 / MAX_RANGE
    p_exact = 0.8 + 0.2 / MAX_RANGE
    p_none = 0.8 * math.exp(-0.5 * (3.5 / 0.5) ** 2) + 0.05
    weight = log_beam_model(HERE, beams(short, exact, none), CORRIDOR, SETTINGS)
    assert weight[0] == pytest.approx(math.log(1.0 + p_short**3 + p_exact**3 + p_none**3))


def test_nan_is_no_beam_and_short_or_far_readings_are_no_return():
    used = evenly_spaced_beams(scan([math.nan, 0.05, 9.0, math.inf, 2.0]), LocalizerSettings(beams=5))
    assert used.ranges.tolist() == [MAX_RANGE, MAX_RANGE, MAX_RANGE, 2.0]


def test_beams_are_spaced_as_amcl_spaces_them():
    count = 640
    few = evenly_spaced_beams(scan(np.ones(count)), LocalizerSettings(beams=60))
    assert few.directions.size == 64 and few.directions[1] == pytest.approx(0.10)
    prob = LocalizerSettings(beams=60, sensor_model="likelihood_field_prob")
    assert evenly_spaced_beams(scan(np.ones(count)), prob).directions[1] == pytest.approx(0.11)
    assert evenly_spaced_beams(scan(np.ones(10)), LocalizerSettings(beams=60)).directions.size == 10


def test_an_upside_down_laser_counts_the_other_way_round():
    mounted = {"laser_in_base": Pose2(0.0, 0.0, 0.5), "upside_down": True}
    used = evenly_spaced_beams(scan([1.0, 1.0], 0.1, 0.2, **mounted), LocalizerSettings(beams=2))
    assert used.directions.tolist() == pytest.approx([0.4, 0.2])


def test_the_parameters_narrow_the_scans_own_limits():
    narrow = LocalizerSettings(beams=4, laser_min_range=1.0, laser_max_range=4.0)
    used = evenly_spaced_beams(scan([0.5, 2.0, 4.5, 3.0]), narrow)
    assert used.max_range == 4.0 and used.ranges.tolist() == [4.0, 2.0, 4.0, 3.0]


@pytest.mark.parametrize("limits", [(0.0, 0.0), (-0.5, 5.0)])
def test_senseless_limits_are_refused(limits):
    with pytest.raises(LocalizationError, match="range_max"):
        evenly_spaced_beams(Scan(0.0, 0.0, 0.1, np.ones(5), *limits), LocalizerSettings())
