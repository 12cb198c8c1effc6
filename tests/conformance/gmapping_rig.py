"""gmapping for cases: ours and the official one."""

from typing import Any, List, Mapping, Optional

from facts import fact_of
from graph import observe, official_node, our_node


def run_ours(case: Mapping[str, Any]) -> Any:
    """Return what our node gives."""
    return _observed(case, our_node("slam_lite.ros.node"))


def run_official(case: Mapping[str, Any]) -> Any:
    """Return what the official node gives; it must be installed."""
    command = official_command(case)
    assert command is not None, "the official node is not installed"
    return _observed(case, command)


def official_command(case: Mapping[str, Any]) -> Optional[List[str]]:
    """Return the command of the official node; None if it is not installed."""
    return official_node("gmapping", "slam_gmapping")


def _observed(case: Mapping[str, Any], command: List[str]) -> Any:
    given = {key: value for key, value in case.items() if key != "fact"}
    return fact_of(observe("observe_gmapping", command, **given), case["fact"])
