"""How a process begins: with imports, which take a second and in which libraries catch whatever is raised."""

import importlib
import sys
from typing import Any

from supervision.fork_client import run_in_fork_server
from supervision.interruption import exiting_on_signals


def start_node(function: str) -> None:
    """Calls the function of a node, as ``call``; in a child of a fork server, if there is one."""
    run_in_fork_server(f"{__name__}:start_forked", function)
    call(function)


def start_forked(function: str) -> None:
    """In a child of the fork server: rospy has read the names of another process' command line there."""
    if "rospy.names" in sys.modules:
        importlib.reload(sys.modules["rospy.names"])
    call(function)


def call(function: str, *arguments: object) -> Any:
    """What the function returns, given as ``package.module:name``; Ctrl-C is heard while that is imported."""
    module, _, name = function.partition(":")
    with exiting_on_signals():
        found = getattr(importlib.import_module(module), name)
    return found(*arguments)
