"""result.json of a run, as described by ``config/result.schema.json``."""

from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional

from planar import FileWriteError, PlanarError
from supervision.run_folder import RESULT_FILE, write_result


class ResultFile:
    """Fields of result.json, written again whenever some are added.

    Attributes:
        folder: Run folder.
        missing: Files that could not be recorded or written, and why.
        gap: Why result.json itself could not be written; None if it is complete.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self._findings: Dict[str, Any] = {}
        self.missing: List[str] = []
        self.gap: Optional[str] = None

    def add(self, **findings: Any) -> None:
        """Set fields; existing ones of the same key are replaced."""
        self._findings.update(findings)

    @property
    def content(self) -> Dict[str, Any]:
        """All fields."""
        return {**self._findings, "missing": self.missing}

    @property
    def all_missing(self) -> List[str]:
        """Everything that is missing, including result.json."""
        return self.missing if self.gap is None else [self.gap, *self.missing]

    @contextmanager
    def recording_gaps(self, name: str) -> Iterator[None]:
        """Record in ``missing`` that the file ``name``, made within the context, could not be made."""
        try:
            yield
        except PlanarError as error:
            self.missing.append(f"{name}: {_reason(error)}")

    def write(self) -> None:
        """Write all fields; delete an outdated file, if it cannot be replaced otherwise."""
        self.gap = self._attempt()
        if self.gap is not None:
            with suppress(OSError):
                (self.folder / RESULT_FILE).unlink()
            self.gap = self._attempt()

    def _attempt(self) -> Optional[str]:
        try:
            write_result(self.folder, self.content)
        except FileWriteError as error:
            return f"{RESULT_FILE}: {_reason(error)}"
        return None


def grouped_by_reason(missing: Iterable[str]) -> List[str]:
    """Group missing files by their reason, for people."""
    names: Dict[str, List[str]] = {}
    for gap in dict.fromkeys(missing):
        name, _, reason = gap.partition(": ")
        names.setdefault(reason, []).append(name)
    return [f"{', '.join(named)}: {reason}" for reason, named in names.items()]


def _reason(error: PlanarError) -> str:
    """Return the message of an error without the leading file name."""
    return str(error).rpartition(": ")[2]
