"""Waiting for something to become so, never for ever."""

import time

PATIENCE_SECONDS = 20.0


def wait_until(what, is_met, seconds=PATIENCE_SECONDS, pause=0.01):
    """Fails with ``what`` there was to wait for, after that wall time; ``pause``: seconds between looks."""
    deadline = time.monotonic() + seconds
    while not is_met():
        assert time.monotonic() < deadline, f"waited {seconds:g} s in vain for {what}"
        time.sleep(pause)
