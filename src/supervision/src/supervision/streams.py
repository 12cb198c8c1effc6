"""Output streams that ignore write errors, as of a full disk or a closed terminal."""

import logging
import sys
from contextlib import suppress
from typing import TextIO


def ignore_write_errors() -> None:
    """From now on stdout, stderr and logs of this process silently drop what cannot be written.

    Otherwise the error would be raised anywhere, in the answer of a service for example, and a traceback
    printed for each line of a log.
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
