"""Waiting for a condition with a time-out."""

import time

PATIENCE_SECONDS = 20.0
# Time limits are for a quiet machine and guard against hangs; one that is shared may be half as fast.
SHARED_MACHINE = 2.0


def wait_until(what, is_met, seconds=PATIENCE_SECONDS, pause=0.01):
    """Wait until ``is_met()``, polled every ``pause`` seconds; fail if it takes longer than ``seconds``."""
    seconds *= SHARED_MACHINE
    deadline = time.monotonic() + seconds
    while not is_met():
        assert time.monotonic() < deadline, f"timed out after {seconds:g} s waiting for {what}"
        time.sleep(pause)
