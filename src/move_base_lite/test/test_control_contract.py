"""Every registered local planner keeps the contract."""

import pytest

from move_base_lite.check import CHECK_SUITES
from move_base_lite.control import LOCAL_PLANNERS


@pytest.mark.parametrize("check", CHECK_SUITES["local_planner"].checks, ids=lambda check: check.__name__)
@pytest.mark.parametrize("member", LOCAL_PLANNERS.members, ids=lambda member: member.short_name)
def test_a_local_planner_keeps_its_contract(member, check):
    check(member)
