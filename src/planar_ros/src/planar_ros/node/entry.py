"""How a process begins: with imports, which take a second and in which libraries catch whatever is raised."""

import argparse
import importlib
import sys
from typing import Any, List

from threadpoolctl import threadpool_limits

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


def use_one_blas_thread() -> None:
    """Matrices here are small: more threads of what is imported would only wait for work, in busy loops."""
    threadpool_limits(1, user_api="blas")


def parse_known(parser: argparse.ArgumentParser, words: List[str]) -> argparse.Namespace:
    """What the parser knows of the words."""
    known, unknown = parser.parse_known_args(words)
    warn_unknown(parser.prog, unknown)
    return known


def warn_unknown(program: str, words: List[str]) -> None:
    """Says which words mean nothing, if there are any."""
    if words:
        print(f"[{program}] goes on without what it does not know: {' '.join(words)}", file=sys.stderr)
