"""Conformance of our amcl to amcl 1.17: one test a statement (``Case.source``)."""

import pytest

pytest.importorskip("rospy")

from amcl_cases import CASES, RIGS  # noqa: E402


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_our_amcl_keeps_the_statement(case):
    """The statement of ``Case.source``, or the stated difference."""
    assert RIGS["amcl"].ours(case.input) == case.expected, case.source


def test_each_difference_from_the_official_node_has_a_reason():
    assert [
        case.name for case in CASES if (case.expected_of_official != case.expected) != bool(case.reason)
    ] == []
