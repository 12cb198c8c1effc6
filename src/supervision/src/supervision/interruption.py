"""How a command hears Ctrl-C, and how it leaves."""

import os
import signal
import sys
from contextlib import contextmanager
from typing import Any, Callable, Iterable, Iterator, List, NoReturn, Tuple

from supervision.errors import RunInterruptedError
from supervision.signal_wakeup import wake_main_thread_on_signals

INTERRUPTED = 130


def _signals() -> Tuple[signal.Signals, ...]:
    """Those that ask for an end; the terminal that closes is none to a command under nohup."""
    asked = (signal.SIGINT, signal.SIGTERM)
    ignores_hangup = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return asked if ignores_hangup else (*asked, signal.SIGHUP)


SIGNALS = _signals()

_is_interrupted = False
_exit_hooks: List[Callable[[], object]] = []


def on_signals(handle: Callable[[int, Any], object], signals: Iterable[int] = SIGNALS) -> None:
    """From now on ``signals`` are handled by ``handle``, in the main thread, even while that waits."""
    for number in signals:
        signal.signal(number, handle)
    wake_main_thread_on_signals()


def exit_when_interrupted() -> None:
    """From now on SIGINT, SIGTERM or SIGHUP ends the process at once: nothing has to be taken down yet.

    Libraries that are being imported catch whatever is raised.
    """
    on_signals(_leave)


@contextmanager
def exiting_on_signals() -> Iterator[None]:
    """Any of ``SIGNALS`` ends the process at once and in silence, where nothing has to be taken down yet."""
    with handling_signals(lambda number, _frame: os._exit(128 + number)):
        yield


@contextmanager
def handling_signals(handle: Callable[[int, Any], object]) -> Iterator[None]:
    """``SIGNALS`` are handled by ``handle``, afterwards as they were before."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    on_signals(handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def raise_when_interrupted() -> None:
    """From now on the first of ``SIGNALS`` raises RunInterruptedError, and further ones are ignored."""
    on_signals(_raise)


def raise_if_interrupted() -> None:
    """Raises RunInterruptedError once more, in case that a library has caught the first one."""
    if _is_interrupted:
        raise RunInterruptedError


def before_exit(do: Callable[[], object]) -> None:
    """Calls it before this process ends of itself, or because it is asked to."""
    _exit_hooks.append(do)


def leave(code: int) -> NoReturn:
    """Ends the process without waiting for threads of ROS that still listen to a master that is gone."""
    sys.stdout.flush()
    _end(code)


def _end(code: int) -> NoReturn:
    for do in _exit_hooks:
        do()
    os._exit(code)


def _leave(_number, _frame):
    ignore_further_signals()
    os.write(sys.stderr.fileno(), b"error: interrupted\n")
    _end(INTERRUPTED)


def _raise(_number, _frame):
    global _is_interrupted
    ignore_further_signals()
    _is_interrupted = True
    raise RunInterruptedError


def ignore_further_signals() -> None:
    """The first of ``SIGNALS`` is being followed: others do not disturb that."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
