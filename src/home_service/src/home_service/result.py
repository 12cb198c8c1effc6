"""What a run leaves for programs: result.json, as ``config/result.schema.json`` describes it."""

from pathlib import Path
from typing import Any, Dict, List

from planar import FileWriteError
from supervision.run_folder import write_result


class Result:
    """Findings by the keys of the schema, from whoever found them; written anew whenever some have come.

    ``missing``: what could not be recorded or written, and why.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._findings: Dict[str, Any] = {}
        self.missing: List[str] = []

    def add(self, **findings: Any) -> None:
        """Keeps findings; one that is known by the same key already gives way."""
        self._findings.update(findings)

    @property
    def content(self) -> Dict[str, Any]:
        return {**self._findings, "missing": self.missing}

    def write(self) -> None:
        try:
            write_result(self._folder, self.content)
        except FileWriteError as error:
            self.missing.append(f"result.json: {str(error).rpartition(': ')[2]}")
