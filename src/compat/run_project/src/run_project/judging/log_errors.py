"""Errors in the logs of a run's terminal windows."""

import re
from pathlib import Path
from typing import Iterable, Iterator, List

MAX_ERRORS = 20
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_ERROR_LINE = re.compile(
    r"^\[ *(?:ERROR|FATAL)\]|\berror:|process has died|Segmentation fault|RLException|ResourceNotFound|"
    r"Resource not found|cannot launch node|command not found|No such file|Couldn't find",
    re.IGNORECASE,
)
_TRACEBACK = "Traceback (most recent call last):"


def find_log_errors(folder: Path) -> List[str]:
    """Find error lines in the logs of a folder.

    Args:
        folder: Folder with a ``*.log`` for each window; ``build.log`` is ignored.

    Returns:
        The first MAX_ERRORS lines as ``LOG: LINE``, without duplicates and colour codes; of a traceback, its
        last line.
    """
    found: List[str] = []
    for log in sorted(set(folder.glob("*.log")) - {folder / "build.log"}):
        for line in _errors_in(log.read_text(errors="replace").splitlines()):
            entry = f"{log.stem}: {line}"
            if entry not in found:
                found.append(entry)
    return found[:MAX_ERRORS]


def _errors_in(lines: Iterable[str]) -> Iterator[str]:
    """Yield error lines, and the first line after each traceback that is not indented."""
    is_in_traceback = False
    for line in lines:
        text = _COLOUR.sub("", line).rstrip()
        is_end = is_in_traceback and bool(text[:1].strip())
        if is_end or _ERROR_LINE.search(text.strip()):
            yield text.strip()
        is_in_traceback = text.endswith(_TRACEBACK) or (is_in_traceback and not is_end)
    if is_in_traceback:
        yield _TRACEBACK
