"""A node for cases: ours and the official one."""

from typing import Any, List, Mapping

from case import Rig
from facts import fact_of
from graph import observe, official_node, our_node


def node_rig(module: str, package: str, executable: str, observer: str) -> Rig:
    """Return the rig of a node whose cases name the ``fact`` to look at.

    Args:
        module: Module of our node.
        package: Package of the official node.
        executable: Executable of the official node.
        observer: Script that runs a node and returns what it observed.
    """

    def observed(case: Mapping[str, Any], command: List[str]) -> Any:
        given = {key: value for key, value in case.items() if key != "fact"}
        return fact_of(observe(observer, command, **given), case["fact"])

    def run_ours(case: Mapping[str, Any]) -> Any:
        return observed(case, our_node(module))

    def run_official(case: Mapping[str, Any]) -> Any:
        command = official_node(package, executable)
        assert command is not None, "the official node is not installed"
        return observed(case, command)

    return Rig(run_ours, run_official, (f"{package}/{executable}",))
