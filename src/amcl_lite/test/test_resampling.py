import math

import numpy as np
import pytest

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.filter.bins import cluster_labels
from amcl_lite.filter.particles import (
    FreeSpace,
    ParticleSet,
    equally_weighted,
    gaussian_particles,
)
from amcl_lite.filter.resampling import particles_needed, resample
from amcl_lite.filter.statistics import best_cluster, has_converged, mean_and_covariance
from planar import Pose2, grid_from_picture

ROOM = grid_from_picture("#####\n#..?#\n#####", resolution=0.5, origin=Pose2(10.0, 0.0, 0.0))
SPACE = FreeSpace(ROOM)


def rng():
    return np.random.default_rng(7)


@pytest.mark.parametrize(
    "bins, error, z, needed",
    [
        # (k-1)/(2 error) (1 - 2/(9(k-1)) + z sqrt(2/(9(k-1))))^3, by hand
        (2, 0.05, 0.99, 20),
        (10, 0.05, 0.99, 134),
        (50, 0.05, 2.326, 750),
        (100, 0.01, 0.99, 5658),
    ],
)
def test_kld_sampling_needs_the_number_of_particles_given_by_fox(bins, error, z, needed):
    k = bins - 1
    formula = k / (2 * error) * (1 - 2 / (9 * k) + z * math.sqrt(2 / (9 * k))) ** 3
    assert particles_needed(bins, 1, 10**6, error, z) == math.ceil(formula)
    assert particles_needed(bins, 1, 10**6, error, z) == pytest.approx(needed, rel=0.05)


def test_the_count_is_kept_within_bounds():
    assert particles_needed(1, 100, 5000, 0.01, 0.99) == 5000
    assert particles_needed(2, 100, 5000, 0.5, 0.99) == 100
    assert particles_needed(1000, 100, 5000, 0.01, 0.99) == 5000


def test_a_narrow_set_shrinks_and_a_wide_one_does_not():
    settings = LocalizerSettings(min_particles=100, max_particles=2000, kld_error=0.05)
    narrow = gaussian_particles(Pose2(0.25, 0.25, 0.0), 0.04 * np.eye(3), 2000, rng())
    wide = gaussian_particles(Pose2(), 25.0 * np.eye(3), 2000, rng())
    assert resample(narrow, settings, 0.0, SPACE.draw, rng()).size < 800
    assert resample(wide, settings, 0.0, SPACE.draw, rng()).size == 2000


def test_particles_are_drawn_in_proportion_to_their_weights():
    poses = np.array([[0.0, 0, 0], [5.0, 0, 0], [10.0, 0, 0]])
    settings = LocalizerSettings(min_particles=20_000, max_particles=20_000)
    drawn = resample(ParticleSet(poses, np.array([0.2, 0.0, 0.8])), settings, 0.0, SPACE.draw, rng())
    share = np.mean(drawn.poses[:, 0] == 0.0)
    assert share == pytest.approx(0.2, abs=4 * math.sqrt(0.2 * 0.8 / 20_000))
    assert not np.any(drawn.poses[:, 0] == 5.0)
    assert drawn.weights.sum() == pytest.approx(1.0)


def test_injected_particles_lie_in_free_space():
    particles = equally_weighted(np.zeros((1000, 3)))
    settings = LocalizerSettings(min_particles=1000, max_particles=1000)
    drawn = resample(particles, settings, 0.3, SPACE.draw, rng())
    injected = drawn.poses[drawn.poses[:, 0] > 5.0]
    assert len(injected) / 1000 == pytest.approx(0.3, abs=4 * math.sqrt(0.3 * 0.7 / 1000))
    assert all(ROOM.value_at(x, y) == 0 for x, y, _ in injected)


def test_a_map_without_free_cells_is_refused():
    with pytest.raises(LocalizationError, match="no free cell"):
        FreeSpace(grid_from_picture("#?\n??"))


def test_gaussian_particles_have_the_mean_and_covariance_asked_for():
    wanted = np.array([[0.5, 0.2, 0.0], [0.2, 0.3, 0.0], [0.0, 0.0, 0.1]])
    particles = gaussian_particles(Pose2(1.0, 2.0, 0.5), wanted, 50_000, rng())
    assert particles.poses.mean(axis=0) == pytest.approx([1.0, 2.0, 0.5], abs=0.015)
    assert np.cov(particles.poses.T) == pytest.approx(wanted, abs=0.015)


def test_a_certain_pose_gives_equal_particles():
    assert np.ptp(gaussian_particles(Pose2(1.0, 2.0, 3.0), np.zeros((3, 3)), 10, rng()).poses) == 2.0


def test_bins_that_touch_make_a_cluster():
    poses = np.array([[0.2, 0.2, 0.05], [0.7, 0.2, 0.05], [1.2, 0.7, 0.2], [5.0, 5.0, 0.0]])
    assert cluster_labels(poses).tolist() == [0, 0, 0, 1]


def test_clusters_reach_across_the_turn_of_the_circle():
    poses = np.array([[0.0, 0.0, math.pi - 0.01], [0.0, 0.0, 0.01 - math.pi], [0.0, 0.0, 0.0]])
    assert cluster_labels(poses).tolist() == [0, 0, 1]


def test_the_mean_is_that_of_the_heaviest_cluster_not_between_two():
    poses = np.array([[0.1, 0.0, math.pi - 0.1], [0.3, 0.0, 0.1 - math.pi], [8.0, 0.0, 0.0]])
    mean, _ = mean_and_covariance(best_cluster(ParticleSet(poses, np.array([0.3, 0.3, 0.4]))))
    assert (mean.x, mean.y) == pytest.approx((0.2, 0.0))
    assert abs(mean.yaw) == pytest.approx(math.pi)


def test_the_covariance_is_that_of_the_whole_set():
    poses = np.array([[0.0, 0.0, 0.3], [2.0, 0.0, -0.3]])
    _, found = mean_and_covariance(equally_weighted(poses))
    assert found[:2, :2].tolist() == [[1.0, 0.0], [0.0, 0.0]]
    assert found[2, 2] == pytest.approx(-2.0 * math.log(math.cos(0.3)))


def test_a_filter_has_converged_when_no_particle_is_far_from_the_mean():
    near = np.array([[0.0, 0.0, 0.0], [0.8, 0.0, 3.0]])
    assert has_converged(equally_weighted(near))
    assert not has_converged(equally_weighted(near * (2.0, 1.0, 1.0)))
