"""Results in one SQLite file; write-ahead logging lets others read it during a campaign."""

import sqlite3
from contextlib import contextmanager
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence, Set, Tuple

from laboratory.errors import ResultsError
from laboratory.results.result import RunResult
from laboratory.tasks.task import ERROR

SCHEMA = 1
KINDS: Dict[Any, str] = {int: "INTEGER", float: "REAL", str: "TEXT", bytes: "BLOB"}
KINDS.update({Optional[int]: "INTEGER", Optional[float]: "REAL"})
COLUMNS = {field.name: KINDS[field.type] for field in fields(RunResult)}
# Seconds to wait for another writer.
BUSY_TIMEOUT = 30.0


class ResultStore:
    """Results in an SQLite file, which is created if it does not exist. All methods raise ResultsError."""

    def __init__(self, path: Path):
        self._path = path
        with self._raising_results_error():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._connection = sqlite3.connect(str(path), timeout=BUSY_TIMEOUT, isolation_level=None)
            self._connection.execute("PRAGMA journal_mode=WAL")
            self._connection.execute("PRAGMA synchronous=NORMAL")
            self._prepare()

    def close(self) -> None:
        self._connection.close()

    def add(self, result: RunResult) -> None:
        """Store a result; replaces one of the same scenario, seed and version."""
        placeholders = ", ".join("?" * len(COLUMNS))
        with self._raising_results_error():
            columns = ", ".join(COLUMNS)
            self._connection.execute(
                f"INSERT OR REPLACE INTO results ({columns}) VALUES ({placeholders})", astuple(result)
            )

    def completed(self, version: str) -> Set[Tuple[str, int]]:
        """Return digests and seeds of completed runs; those with an error are left out, to be repeated."""
        query = "SELECT digest, seed FROM results WHERE version = ? AND outcome != ?"
        with self._raising_results_error():
            return set(self._connection.execute(query, (version, ERROR)).fetchall())

    def results(self, digest: str, version: str) -> List[RunResult]:
        """Return the results of a scenario, ordered by seed."""
        query = (
            f"SELECT {', '.join(COLUMNS)} FROM results "
            "WHERE digest = ? AND version = ? AND outcome IS NOT NULL ORDER BY seed"
        )
        with self._raising_results_error():
            return [_result(row) for row in self._connection.execute(query, (digest, version))]

    def versions(self) -> List[str]:
        """Return the versions of all results, the latest last."""
        query = "SELECT version FROM results GROUP BY version ORDER BY MAX(rowid)"
        with self._raising_results_error():
            return [version for (version,) in self._connection.execute(query)]

    def _prepare(self) -> None:
        (schema,) = self._connection.execute("PRAGMA user_version").fetchone()
        if schema not in (0, SCHEMA):
            raise ResultsError(
                f"{self._path}: written by another software version (schema {schema}, expected {SCHEMA}); "
                "use another --output"
            )
        columns = ", ".join(f"{name} {kind}" for name, kind in COLUMNS.items())
        key = "PRIMARY KEY (digest, seed, version)"
        self._connection.execute(f"CREATE TABLE IF NOT EXISTS results ({columns}, {key})")
        existing = {column[1] for column in self._connection.execute("PRAGMA table_info(results)")}
        # Files of earlier versions lack the newer columns.
        for name in [each for each in COLUMNS if each not in existing]:
            self._connection.execute(f"ALTER TABLE results ADD COLUMN {name} {COLUMNS[name]}")
        self._connection.execute(f"PRAGMA user_version = {SCHEMA}")

    @contextmanager
    def _raising_results_error(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, OSError) as error:
            if type(error) is sqlite3.DatabaseError:  # the file itself, not an operation on it
                advice = f"move it away, or try: sqlite3 {self._path} .recover"
                raise ResultsError(f"{self._path}: {error}; the file is damaged: {advice}") from None
            raise ResultsError(f"{self._path}: {error}; results stored so far are intact") from None


def _result(row: Sequence[Any]) -> RunResult:
    """Return the result of a row; columns without a value have their defaults."""
    values = {name: value for name, value in zip(COLUMNS, row) if value is not None}
    return RunResult(**{"reason": "", **values})
