"""Signals wake the main thread, whichever thread takes them.

Python calls handlers in the main thread only, when that works on. Linux offers the main thread a signal for
the process, but another one that unblocks signals just then, as each does that starts a thread, takes it
first. A main thread that waits for a lock is not woken by that, and hears of the signal with the next one.
"""

import os
import signal
import threading
import time

# Nobody else's: all that it does is to interrupt what the main thread waits for.
WAKEUP_SIGNAL = signal.SIGURG
# The first may come just before the main thread begins to wait.
WAKEUPS, BETWEEN_SECONDS = 2, 0.1
MOST_AT_ONCE = 64

_woken_process = 0


def wake_main_thread_on_signals() -> None:
    """Does so from now on. Called by the main thread, as often as it likes."""
    global _woken_process
    if _woken_process == os.getpid():
        return
    _woken_process = os.getpid()
    reading, writing = os.pipe2(os.O_CLOEXEC)
    os.set_blocking(writing, False)
    signal.signal(WAKEUP_SIGNAL, lambda _number, _frame: None)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    main_thread = threading.get_ident()
    threading.Thread(target=_wake, args=[reading, main_thread], name="waking", daemon=True).start()


def _wake(reading: int, main_thread: int) -> None:
    while True:
        numbers = os.read(reading, MOST_AT_ONCE)
        if set(numbers) == {WAKEUP_SIGNAL}:
            continue
        for _ in range(WAKEUPS):
            signal.pthread_kill(main_thread, WAKEUP_SIGNAL)
            time.sleep(BETWEEN_SECONDS)
