"""Sources of keys: a terminal or a pipe, read without blocking for long."""

import contextlib
import os
import select
import termios
import tty

from planar import PlanarError

CTRL_C = "\x03"
CHUNK_BYTES = 4096


class NoKeysError(PlanarError):
    """Standard input is neither a terminal nor a script."""


class Terminal:
    """Context that switches a terminal to raw mode: single keys, no echo. The old mode is restored on exit.

    Ctrl-C is read as a key, except on another session's terminal, as under roslaunch, which handles it.

    Args:
        descriptor: File descriptor of the terminal.

    Raises:
        NoKeysError: It is not a terminal, or not of the foreground process.
    """

    def __init__(self, descriptor: int):
        self._descriptor = descriptor
        if not os.isatty(descriptor):
            raise NoKeysError("there is no keyboard here: standard input is not a terminal")
        self._is_own_session = _is_of_this_session(descriptor)
        if self._is_own_session and os.tcgetpgrp(descriptor) != os.getpgrp():
            raise NoKeysError("the terminal belongs to another process: start this in the foreground")

    def __enter__(self) -> "Terminal":
        self._attributes = termios.tcgetattr(self._descriptor)
        tty.setraw(self._descriptor, termios.TCSANOW)
        raw = termios.tcgetattr(self._descriptor)
        raw[1] |= termios.OPOST  # keep "\n" a new line for whatever this process prints
        if not self._is_own_session:
            raw[3] |= termios.ISIG
        termios.tcsetattr(self._descriptor, termios.TCSANOW, raw)
        return self

    def __exit__(self, *_) -> None:
        with contextlib.suppress(termios.error):  # the terminal may be gone
            termios.tcsetattr(self._descriptor, termios.TCSADRAIN, self._attributes)

    def read(self, timeout: float) -> str:
        """Read keys; Ctrl-C if the terminal was closed.

        Args:
            timeout: Longest time to wait for a key [s].
        """
        return _read(self._descriptor, timeout, at_end=CTRL_C)


class Pipe:
    """Lines from a pipe or file.

    Args:
        descriptor: File descriptor of the input.

    Attributes:
        is_at_end: Whether the end of the input was reached.
    """

    def __init__(self, descriptor: int):
        self._descriptor = descriptor
        self._rest = ""
        self.is_at_end = False

    def read(self) -> str:
        """Read the complete lines available; at the end of the input also an incomplete one."""
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
