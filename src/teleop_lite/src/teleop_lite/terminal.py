"""Where keys come from: a terminal or a pipe, read without ever blocking for long."""

import contextlib
import os
import select
import termios
import tty

from planar import PlanarError

CTRL_C = "\x03"
CHUNK_BYTES = 4096


class NoKeysError(PlanarError):
    """There is neither a keyboard nor a script."""


class Terminal:
    """Context in which the keys of a terminal arrive one by one and unseen; leaving it restores all.

    Ctrl-C is a key as well, except on another session's terminal, as under roslaunch: it is meant for that.
    """

    def __init__(self, descriptor: int):
        self._descriptor = descriptor
        if not os.isatty(descriptor):
            raise NoKeysError("there is no keyboard here: standard input is no terminal")
        self._is_ours = _is_of_this_session(descriptor)
        if self._is_ours and os.tcgetpgrp(descriptor) != os.getpgrp():
            raise NoKeysError("the terminal belongs to another process: start this in the foreground")

    def __enter__(self) -> "Terminal":
        self._attributes = termios.tcgetattr(self._descriptor)
        tty.setraw(self._descriptor, termios.TCSANOW)
        raw = termios.tcgetattr(self._descriptor)
        raw[1] |= termios.OPOST  # keep "\n" a new line for whatever this process prints
        if not self._is_ours:
            raw[3] |= termios.ISIG
        termios.tcsetattr(self._descriptor, termios.TCSANOW, raw)
        return self

    def __exit__(self, *_) -> None:
        with contextlib.suppress(termios.error):  # the terminal may be gone
            termios.tcsetattr(self._descriptor, termios.TCSADRAIN, self._attributes)

    def read(self, timeout: float) -> str:
        """Keys, as soon as there are any within ``timeout`` seconds; Ctrl-C if the terminal is gone."""
        return _read(self._descriptor, timeout, at_end=CTRL_C)


class Pipe:
    """Lines that arrive on a pipe or file."""

    def __init__(self, descriptor: int):
        self._descriptor = descriptor
        self._rest = ""
        self.is_at_end = False

    def read(self) -> str:
        """Whole lines that have arrived since the last call; at the end of the input also what is left."""
        while not self.is_at_end and select.select([self._descriptor], [], [], 0.0)[0]:
            text = _read(self._descriptor, 0.0, at_end="")
            self.is_at_end = not text
            self._rest += text
        lines, newline, self._rest = self._rest.rpartition("\n")
        if self.is_at_end:
            lines, self._rest = lines + newline + self._rest, ""
        return lines


def _read(descriptor: int, timeout: float, at_end: str) -> str:
    if not select.select([descriptor], [], [], timeout)[0]:
        return ""
    try:
        chunk = os.read(descriptor, CHUNK_BYTES)
    except OSError:  # the other side of a terminal has hung up
        chunk = b""
    return chunk.decode("utf-8", errors="replace") or at_end


def _is_of_this_session(descriptor: int) -> bool:
    try:
        os.tcgetpgrp(descriptor)
    except OSError:
        return False
    return True
