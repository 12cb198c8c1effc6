"""What a run leaves for programs: result.json, as ``config/result.schema.json`` describes it."""

from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional

from planar import FileWriteError, PlanarError
from supervision.run_folder import RESULT_FILE, write_result


class ResultError(PlanarError):
    """The result of a run cannot be written; for programs the run is no success then."""


class ResultFile:
    """Findings by the keys of the schema, from whoever found them; written anew whenever some have come.

    ``missing``: what could not be recorded or written, and why. ``gap``: the same of result.json itself, None
    if it stands there as it should.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self._findings: Dict[str, Any] = {}
        self.missing: List[str] = []
        self.gap: Optional[str] = None

    def add(self, **findings: Any) -> None:
        """Keeps findings; one that is known by the same key already gives way."""
        self._findings.update(findings)

    @property
    def content(self) -> Dict[str, Any]:
        return {**self._findings, "missing": self.missing}

    @property
    def all_missing(self) -> List[str]:
        """What is missing, result.json too."""
        return self.missing if self.gap is None else [self.gap, *self.missing]

    @contextmanager
    def recording_gaps(self, name: str) -> Iterator[None]:
        """Something of that name is made within; if it cannot be, it is missing."""
        try:
            yield
        except PlanarError as error:
            self.missing.append(f"{name}: {_reason(error)}")

    def write(self) -> None:
        """One that tells less than is known by now is none: it makes room for the new one, or is gone."""
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
    """What is missing, each reason once."""
    names: Dict[str, List[str]] = {}
    for gap in dict.fromkeys(missing):
        name, _, reason = gap.partition(": ")
        names.setdefault(reason, []).append(name)
    return [f"{', '.join(named)}: {reason}" for reason, named in names.items()]


def _reason(error: PlanarError) -> str:
    """What an error says after the name of the file that stands in it."""
    return str(error).rpartition(": ")[2]
