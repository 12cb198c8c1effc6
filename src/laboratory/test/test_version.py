"""The version of the software that computes results."""

from laboratory.results.version import SOURCES, packages


def test_packages_that_compute_results_follow_from_the_dependencies():
    found = set(packages())
    assert {"laboratory", "planar", "sim_bridge", "amcl_lite", "slam_lite", "move_base_lite"} <= found
    assert {"planar_ros", "sim_bridge_msgs", "map_lite", "plugin_examples"} <= found
    assert not {"cockpit", "home_service_gym"} & found
    assert all((SOURCES / name / "package.xml").is_file() for name in found)
