"""Wake the main thread when another thread takes a signal.

Python runs signal handlers in the main thread only, when it executes code again. Linux prefers the main
thread for a signal of the process, but another thread that unblocks signals at that moment, as when it
starts a thread, may take it first. A main thread that waits for a lock is not woken by that and would run
the handler only after the next signal.
"""

import os
import signal
import threading
import time

# Used for nothing else: it only interrupts what the main thread waits for.
WAKEUP_SIGNAL = signal.SIGURG
# The first may arrive just before the main thread starts to wait.
WAKEUPS, BETWEEN_SECONDS = 2, 0.1
MOST_AT_ONCE = 64

_woken_process = 0


def wake_main_thread_on_signals() -> None:
    """Wake the main thread from now on; to be called by the main thread, any number of times."""
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
