"""Every example keeps its contract."""

import pytest

from amcl_lite.check import CHECK_SUITES as LOCALIZATION
from move_base_lite.check import CHECK_SUITES as NAVIGATION
from slam_lite.check import CHECK_SUITES as MAPPING

CHECK_SUITES = {**NAVIGATION, **LOCALIZATION, **MAPPING}
EXAMPLES = [
    ("local_planner", "plugin_examples.pure_pursuit/PurePursuit"),
    ("local_planner", "plugin_examples.potential_field/PotentialField"),
    ("local_planner", "plugin_examples.critics/Critics"),
    ("local_planner", "plugin_examples.learned/Learned"),
    ("global_planner", "plugin_examples.rrt_star/RrtStar"),
    ("costmap_layer", "plugin_examples.social_distance/SocialDistance"),
    ("sensor_model", "plugin_examples.short_readings/ShortReadings"),
    ("scan_matcher", "plugin_examples.closest_points/ClosestPoints"),
]
CASES = {
    f"{name.rpartition('/')[2]}-{check.__name__}": (CHECK_SUITES[kind], name, check)
    for kind, name in EXAMPLES
    for check in CHECK_SUITES[kind].checks
}


@pytest.mark.parametrize("case", CASES)
def test_an_example_keeps_its_contract(case):
    kit, name, check = CASES[case]
    check(kit.find(name))
