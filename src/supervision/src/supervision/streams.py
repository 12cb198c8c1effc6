"""Streams and logs that cannot be written, as on a full disk or when the terminal is gone, stop nobody."""

import logging
import sys
from contextlib import suppress
from typing import TextIO


def ignore_write_errors() -> None:
    """From now on stdout, stderr and logs of this process lose what they cannot write, in silence.

    It would be raised in whatever the process is doing, a service's answer for example, and told by a
    traceback for each line of a log.
    """
    logging.raiseExceptions = False
    sys.stdout, sys.stderr = _LossyStream(sys.stdout), _LossyStream(sys.stderr)


class _LossyStream:
    """A stream that drops what cannot be written."""

    def __init__(self, stream: TextIO):
        self._stream = stream

    def __getattr__(self, name: str):
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        with suppress(OSError):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        with suppress(OSError):
            self._stream.flush()
