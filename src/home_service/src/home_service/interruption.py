"""How a command hears Ctrl-C, and how it leaves."""

import os
import signal
import sys

from home_service.errors import RunInterruptedError


def raise_when_interrupted() -> None:
    """From now on the first SIGINT or SIGTERM raises RunInterruptedError, and further ones are ignored."""
    signal.signal(signal.SIGINT, _interrupt)
    signal.signal(signal.SIGTERM, _interrupt)


def leave(code: int) -> None:
    """Ends the process without waiting for threads of ROS that still listen to a master that is gone."""
    sys.stdout.flush()
    os._exit(code)


def _interrupt(number, _frame):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise RunInterruptedError(signal.Signals(number).name)
