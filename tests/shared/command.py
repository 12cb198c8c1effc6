"""A command in a terminal: its output line by line, until Ctrl-C."""

import signal
import subprocess
import threading

from waiting import wait_until

START_SECONDS, END_SECONDS = 120.0, 60.0
URL = "cockpit: "


class Command:
    """Starts a command with an empty standard input; ``lines`` is its output so far."""

    def __init__(self, *words, **more):
        self.process = subprocess.Popen(
            [str(word) for word in words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            **more,
        )
        self.lines = []
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        self.end()
        if kind is not None:
            print("".join(self.lines))

    @property
    def url(self):
        """URL of the page that it serves."""
        return self.wait_for_line(URL)

    def wait_for_line(self, beginning, seconds=START_SECONDS):
        """Wait for a line with this beginning and return the rest of it."""
        wait_until(f"a line '{beginning}'", lambda: self._has_ended() or self._following(beginning), seconds)
        found = self._following(beginning)
        assert found is not None, f"'{beginning}' is nowhere in:\n{''.join(self.lines)}"
        return found

    def end(self):
        """Interrupt the command if it is running, and return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(END_SECONDS)
        self._reading.join(END_SECONDS)
        return code

    def _has_ended(self):
        return self.process.poll() is not None and not self._reading.is_alive()

    def _following(self, beginning):
        lines = [line.strip() for line in list(self.lines)]
        return next((line[len(beginning) :] for line in lines if line.startswith(beginning)), None)

    def _read(self):
        assert self.process.stdout is not None
        self.lines.extend(self.process.stdout)
