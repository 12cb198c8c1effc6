"""Conformance of our gmapping to gmapping 1.4: one test a statement (``Case.source``)."""

import pytest

pytest.importorskip("rospy")

from gmapping_cases import CASES, DEFAULTS, RIGS  # noqa: E402

from planar.config.parameters import parameters_of  # noqa: E402
from slam_lite.config import NodeSettings  # noqa: E402


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_our_gmapping_keeps_the_statement(case):
    """The statement of ``Case.source``, or the stated difference."""
    assert RIGS["gmapping"].ours(case.input) == case.expected, case.source


def test_each_difference_from_the_official_node_has_a_reason():
    assert [
        case.name for case in CASES if (case.expected_of_official != case.expected) != bool(case.reason)
    ] == []


@pytest.mark.parametrize("name", DEFAULTS)
def test_our_defaults_are_those_of_slam_gmapping_cpp(name):
    """Source: gmapping/src/slam_gmapping.cpp, ``SlamGMapping::init``."""
    (ours,) = (each.default for each in parameters_of(NodeSettings) if each.name == name)
    assert ours == DEFAULTS[name]
