"""How a process begins: with imports, which take a second and in which libraries catch whatever is raised."""

import importlib
import os
import signal
import sys
from contextlib import contextmanager
from typing import Any, Callable, Iterator

from supervision.forked import live_forked

# A terminal that closes asks for an end too, but not those that were started to outlive it.
IS_DEAF = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
INTERRUPTS = (signal.SIGINT, signal.SIGTERM) if IS_DEAF else (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def start_node(function: str) -> None:
    """Calls the function of a node, as ``call``; in a child of a fork server, if there is one."""
    live_forked(f"{__name__}:start_forked", function)
    call(function)


def start_forked(function: str) -> None:
    """In a child of the fork server: rospy has read the names of another process' command line there."""
    if "rospy.names" in sys.modules:
        importlib.reload(sys.modules["rospy.names"])
    call(function)


def call(function: str, *arguments: object) -> Any:
    """What the function returns, given as ``package.module:name``; Ctrl-C is heard while that is imported."""
    module, _, name = function.partition(":")
    with leaving_when_interrupted():
        found = getattr(importlib.import_module(module), name)
    return found(*arguments)


@contextmanager
def leaving_when_interrupted() -> Iterator[None]:
    """Signals of ``INTERRUPTS`` end the process at once, where nothing has to be taken down yet."""
    with handling_interrupts(_leave):
        yield


@contextmanager
def handling_interrupts(handle: Callable[[int, Any], object]) -> Iterator[None]:
    """Signals of ``INTERRUPTS`` are handled by ``handle``, afterwards as they were before."""
    before = {number: signal.signal(number, handle) for number in INTERRUPTS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _leave(number, _frame):
    os._exit(128 + number)
