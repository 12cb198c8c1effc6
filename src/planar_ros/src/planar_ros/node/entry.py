"""Process entry points: imports that can be interrupted, command lines, BLAS threads."""

import argparse
import importlib
import sys
from typing import Any, List

from supervision.fork_client import run_in_fork_server
from supervision.interruption import exiting_on_signals


def start_node(function: str) -> None:
    """Call the main function of a node; if there is a fork server, in a child of it."""
    run_in_fork_server(f"{__name__}:start_forked", function)
    call(function)


def start_forked(function: str) -> None:
    """Call the main function in a child of the fork server, with rospy's names of its command line."""
    if "rospy" in sys.modules:
        importlib.import_module("rospy_transport.node").reload_remappings()
    call(function)


def call(function: str, *arguments: object) -> Any:
    """Import and call ``package.module:name``; signals end the process also during the import."""
    module, _, name = function.partition(":")
    with exiting_on_signals():
        found = getattr(importlib.import_module(module), name)
    return found(*arguments)


def use_one_blas_thread() -> None:
    """Limit BLAS to one thread: the matrices are small, and further threads would only spin."""
    from threadpoolctl import threadpool_limits  # late: a client of the fork server needs nothing of it

    threadpool_limits(1, user_api="blas")


def parse_known(parser: argparse.ArgumentParser, words: List[str]) -> argparse.Namespace:
    """Parse the known arguments of a command line; warn of unknown ones, which official nodes accept."""
    known, unknown = parser.parse_known_args(words)
    warn_unknown(parser.prog, unknown)
    return known


def warn_unknown(program: str, words: List[str]) -> None:
    """Print a warning with the unknown arguments, if there are any."""
    if words:
        print(f"[{program}] ignoring unknown arguments: {' '.join(words)}", file=sys.stderr)
