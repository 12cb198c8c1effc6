"""Conformance of move_base to move_base 1.17 and its planners: one test a statement (``Case.source``)."""

import pytest
from move_base_cases import CASES, RIGS


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_our_move_base_keeps_the_statement(case):
    """The statement of ``Case.source`` (move_base, navfn, .cfg files), or the stated difference."""
    assert RIGS[case.rig].ours(case.input) == case.expected, case.source


def test_each_difference_from_the_official_node_has_a_reason():
    for case in CASES:
        assert (case.expected_of_official != case.expected) == bool(case.reason), case.name
