"""Reads one file within limits of time and memory, and classifies the outcome."""

import os
import resource
import signal
import traceback
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, Optional, Tuple

from readers import ROOT, Reader

from planar import PlanarError

# Limit of CPU time [s]; that of wall-clock time is six times as long.
SECONDS = 5.0
MORE_BYTES = 1 << 30


class TooLongError(BaseException):
    """The time limit is exceeded; not an Exception, so that no reader catches it."""


@dataclass(frozen=True)
class Outcome:
    """Outcome of reading a file.

    Attributes:
        fault: What is wrong with the reader; None if it read or rejected the file.
        path: Code path through the reader, to distinguish faults.
    """

    fault: Optional[str]
    path: Tuple[object, ...]


def tried(reader: Reader, path: Path) -> Outcome:
    """Read a file and return the outcome."""
    before = _most_bytes()
    try:
        with _time_limit():
            reader.read(path)
    except PlanarError as error:
        outcome = Outcome(None, _code_path(error))
    except TooLongError:
        return Outcome(f"not read within {SECONDS:g} s", ("too long",))
    except BaseException as error:
        text = " ".join(str(error).split())[:200]
        return Outcome(
            f"{type(error).__name__} in {_place(error)}: {text}", ("fault", type(error), _place(error))
        )
    else:
        outcome = Outcome(None, ("read",))
    if _most_bytes() - before > MORE_BYTES:
        return Outcome("takes more than 1 GB", ("memory", *outcome.path))
    return outcome


def limit_memory() -> None:
    """Limit the memory of this process, to protect the machine."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * os.sysconf("SC_PAGE_SIZE") + 2 * MORE_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _most_bytes() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


@contextmanager
def _time_limit() -> Iterator[None]:
    def end(_number, _frame):
        raise TooLongError

    before = {number: signal.signal(number, end) for number in (signal.SIGPROF, signal.SIGALRM)}
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    signal.setitimer(signal.ITIMER_REAL, 6.0 * SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)


def _code_path(error: BaseException) -> Tuple[object, ...]:
    lines = tuple((code.co_name, number) for code, number in _frames(error))
    return (type(error).__name__, *lines)


def _frames(error: BaseException):
    return [(frame.f_code, number) for frame, number in traceback.walk_tb(error.__traceback__)]


def _place(error: BaseException) -> str:
    """Return the last line in src/ of the traceback."""
    ours = [
        f"{Path(code.co_filename).relative_to(ROOT)}:{number}"
        for code, number in _frames(error)
        if code.co_filename.startswith(str(ROOT / "src"))
    ]
    return ours[-1] if ours else "nowhere"
