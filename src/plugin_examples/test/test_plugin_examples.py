"""Every example keeps its contract."""

import pytest

from move_base_lite.check import KITS

EXAMPLES = [
    ("local_planner", "plugin_examples.pure_pursuit/PurePursuit"),
    ("local_planner", "plugin_examples.potential_field/PotentialField"),
    ("local_planner", "plugin_examples.learned/Learned"),
    ("global_planner", "plugin_examples.rrt_star/RrtStar"),
    ("costmap_layer", "plugin_examples.social_distance/SocialDistance"),
]
CASES = {
    f"{name.rpartition('/')[2]}-{check.__name__}": (KITS[kind], name, check)
    for kind, name in EXAMPLES
    for check in KITS[kind].checks
}


@pytest.mark.parametrize("case", CASES)
def test_an_example_keeps_its_contract(case):
    kit, name, check = CASES[case]
    check(kit.registry.find(name))
