"""Conformance of our costmaps to costmap_2d 1.17: one test a statement of its source (``Case.source``)."""

import pytest
from costmap_2d_cases import CASES
from costmap_2d_rig import run_ours


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_our_costmap_keeps_the_statement(case):
    """The statement of ``Case.source`` (costmap_2d/plugins, costmap_2d/src), or the stated difference."""
    assert run_ours(case.input) == case.expected, case.source


def test_each_difference_from_the_official_node_has_a_reason():
    for case in CASES:
        assert (case.expected_of_official != case.expected) == bool(case.reason), case.name
