"""Handling of Ctrl-C and termination signals, and exit of a command."""

import os
import signal
import sys
import threading
import time
from contextlib import contextmanager
from typing import Any, Callable, Iterable, Iterator, List, NoReturn, Tuple

from supervision.errors import RunInterruptedError

INTERRUPTED = 130
# Used for nothing else: it only interrupts what the main thread waits for.
WAKEUP_SIGNAL = signal.SIGURG
# The first may arrive just before the main thread starts to wait.
WAKEUPS, BETWEEN_SECONDS = 2, 0.1
MOST_AT_ONCE = 64

_woken_process = 0


def _signals() -> Tuple[signal.Signals, ...]:
    """Return the signals that request the end; SIGHUP is ignored under nohup."""
    asked = (signal.SIGINT, signal.SIGTERM)
    ignores_hangup = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return asked if ignores_hangup else (*asked, signal.SIGHUP)


SIGNALS = _signals()

_is_interrupted = False
_exit_hooks: List[Callable[[], object]] = []


def on_signals(handle: Callable[[int, Any], object], signals: Iterable[int] = SIGNALS) -> None:
    """Handle signals in the main thread, even while it waits.

    Args:
        handle: Called with the signal's number and the frame.
        signals: Signals to handle.
    """
    for number in signals:
        signal.signal(number, handle)
    _wake_main_thread_on_signals()


def exit_when_interrupted() -> None:
    """From now on a termination signal ends the process at once; nothing needs to be cleaned up yet.

    The handler raises nothing, since libraries that are being imported may catch it.
    """
    on_signals(_leave)


@contextmanager
def exiting_on_signals() -> Iterator[None]:
    """Context in which a termination signal ends the process at once and silently."""
    with handling_signals(lambda number, _frame: os._exit(128 + number)):
        yield


@contextmanager
def handling_signals(handle: Callable[[int, Any], object]) -> Iterator[None]:
    """Context in which termination signals are handled by ``handle``."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    on_signals(handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def raise_when_interrupted() -> None:
    """From now on the first termination signal raises RunInterruptedError, and further ones are ignored."""
    on_signals(_raise)


def raise_if_interrupted() -> None:
    """Raise RunInterruptedError again, in case a library has caught the first one."""
    if _is_interrupted:
        raise RunInterruptedError


def before_exit(do: Callable[[], object]) -> None:
    """Call a function before this process exits by ``leave`` or is interrupted."""
    _exit_hooks.append(do)


def leave(code: int) -> NoReturn:
    """Exit without waiting for threads of ROS that still try to reach a dead master."""
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
    """Ignore termination signals, since the first one is being handled."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _wake_main_thread_on_signals() -> None:
    """Wake the main thread from now on; to be called by the main thread, any number of times.

    Python runs signal handlers in the main thread only, when it executes code again. Linux prefers the main
    thread for a signal of the process, but another thread that unblocks signals at that moment, as when it
    starts a thread, may take it first. A main thread that waits for a lock is not woken by that and would run
    the handler only after the next signal.
    """
    global _woken_process
    if _woken_process == os.getpid():
        return
    _woken_process = os.getpid()
    reading, writing = os.pipe2(os.O_CLOEXEC)
    os.set_blocking(writing, False)
    signal.signal(WAKEUP_SIGNAL, lambda _number, _frame: None)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    main_thread = threading.get_ident()
    threading.Thread(target=_wake, args=[reading, main_thread], name="signal_wakeup", daemon=True).start()


def _wake(reading: int, main_thread: int) -> None:
    while True:
        numbers = os.read(reading, MOST_AT_ONCE)
        if set(numbers) == {WAKEUP_SIGNAL}:
            continue
        for _ in range(WAKEUPS):
            signal.pthread_kill(main_thread, WAKEUP_SIGNAL)
            time.sleep(BETWEEN_SECONDS)
