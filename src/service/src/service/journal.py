"""Journal of the service: SQLite with a write-ahead log, so that it survives the loss of power at any moment.

One transaction holds what one call of the service has changed; it is on the disk before the robot moves and
before anybody is answered. Its size is bounded: old history is removed.
"""

import fcntl
import json
import sqlite3
from contextlib import closing, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any, Dict, Iterator, List, Optional, Tuple

from planar import Pose2
from service.errors import JournalError
from service.requests.request import request_from_json, request_to_json
from service.task import OPEN, ObjectState, Series, ServiceTask, TaskStatus
from service.task_book import Changes, JournalEntry, RobotRecord, Snapshot

# Version of the tables, in SQLite's user_version; the application id marks the file as a journal.
VERSION, APPLICATION = 1, 0x48535256
SCHEMA = """
CREATE TABLE task (id TEXT PRIMARY KEY, number INTEGER, status TEXT, finished REAL, body TEXT) WITHOUT ROWID;
CREATE INDEX task_by_status ON task (status, number);
CREATE INDEX task_by_end ON task (finished);
CREATE TABLE object (name TEXT PRIMARY KEY, body TEXT) WITHOUT ROWID;
CREATE TABLE series (id TEXT PRIMARY KEY, next REAL, body TEXT) WITHOUT ROWID;
CREATE TABLE log (number INTEGER PRIMARY KEY AUTOINCREMENT, stamp REAL, kind TEXT, task TEXT, text TEXT);
CREATE TABLE state (name TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
"""
OPEN_STATES = tuple(status.value for status in OPEN)


@dataclass(frozen=True)
class JournalLimits:
    """Bounds of a journal.

    Attributes:
        ended_tasks: Tasks that have ended and are kept.
        log_entries: Entries of the log that are kept.
        pages: Size at which the journal is full, in pages of 4 kB: 64 MB.
    """

    ended_tasks: int = 10_000
    log_entries: int = 50_000
    pages: int = 16_384


class Journal:
    """Stores and restores the state of a service.

    Args:
        path: File of the journal; it is created if it does not exist.
        limits: Bounds.
        is_reader: Open it only to read, beside a running service.

    Raises:
        JournalError: If it cannot be opened, is damaged, or is of another version.
    """

    def __init__(self, path: Path, limits: JournalLimits = JournalLimits(), is_reader: bool = False):
        self.path, self._limits = path, limits
        self._numbers: Dict[str, int] = {}
        self._next_number = 1
        self._lock: Optional[IO[str]] = None
        try:
            if is_reader:
                self._connection = sqlite3.connect(
                    f"{path.resolve().as_uri()}?mode=ro", uri=True, timeout=5.0
                )
            else:
                path.parent.mkdir(parents=True, exist_ok=True)
                self._lock = _locked(path)
                self._connection = sqlite3.connect(str(path), timeout=5.0, check_same_thread=False)
            self._connection.isolation_level = None
            self._prepare(is_reader)
        except (sqlite3.Error, OSError) as error:
            raise self._error(error) from None

    def close(self) -> None:
        """Close the file."""
        with suppress(sqlite3.Error):
            self._connection.close()
        if self._lock is not None:
            self._lock.close()

    def store(self, changes: Changes, next_number: int) -> None:
        """Store changes in one transaction; on return they are on the disk.

        Args:
            changes: What has changed.
            next_number: Number of the next task.

        Raises:
            JournalError: If they cannot be stored; then none of them is.
        """
        try:
            self._execute("BEGIN IMMEDIATE")
            try:
                self._write(changes, next_number)
                self._execute("COMMIT")
            except BaseException:
                with suppress(sqlite3.Error):
                    self._execute("ROLLBACK")
                raise
        except sqlite3.Error as error:
            raise self._error(error) from None

    def restore(self) -> Snapshot:
        """Return what is needed to continue.

        Raises:
            JournalError: If it is damaged.
        """
        try:
            marks = ",".join("?" * len(OPEN_STATES))
            rows = self._rows(
                f"SELECT id, body FROM task WHERE status IN ({marks}) ORDER BY number", *OPEN_STATES
            )
            tasks = tuple(_task(*row) for row in rows)
            objects = {name: _object(body) for name, body in self._rows("SELECT name, body FROM object")}
            series = tuple(
                Series(name, request_from_json(json.loads(body)), due)
                for name, due, body in self._rows("SELECT id, next, body FROM series ORDER BY id")
            )
            state = dict(self._rows("SELECT name, value FROM state"))
            latest = next(self._rows("SELECT max(stamp) FROM log"))[0] or 0.0
            robot = _robot(state["robot"]) if "robot" in state else None
            return Snapshot(tasks, objects, series, robot, int(state.get("next_number", 1)), float(latest))
        except (sqlite3.Error, ValueError, LookupError, TypeError) as error:
            raise self._error(error) from None

    def ended_task(self, task_id: str) -> Optional[ServiceTask]:
        """Return a task that has ended; None if there is none of that id."""
        row = next(self._rows("SELECT id, body, status FROM task WHERE id = ?", task_id), None)
        return None if row is None or row[2] in OPEN_STATES else _task(row[0], row[1])

    def ended_tasks(self, since: float = 0.0, limit: int = 1000) -> List[ServiceTask]:
        """Return tasks that ended after a Unix time, the latest first."""
        query = "SELECT id, body FROM task WHERE finished > ? ORDER BY finished DESC, number DESC LIMIT ?"
        return [_task(*row) for row in self._rows(query, since, limit)]

    def log_after(self, number: int, limit: int = 1000) -> List[Tuple[int, JournalEntry]]:
        """Return entries of the log after a number, with their numbers."""
        query = "SELECT number, stamp, kind, task, text FROM log WHERE number > ? ORDER BY number LIMIT ?"
        return [(row[0], JournalEntry(*row[1:])) for row in self._rows(query, number, limit)]

    @property
    def latest_number(self) -> int:
        """Number of the latest entry of the log."""
        return next(self._rows("SELECT max(number) FROM log"))[0] or 0

    def _prepare(self, is_reader: bool) -> None:
        version = next(self._rows("PRAGMA user_version"))[0]
        is_new = version == 0 and next(self._rows("SELECT count(*) FROM sqlite_master"))[0] == 0
        if not is_new and next(self._rows("PRAGMA application_id"))[0] != APPLICATION:
            raise JournalError(
                f"{self.path}: is no journal of this service; name another folder with --state"
            )
        if not is_new and version != VERSION:
            raise JournalError(
                f"{self.path}: is a journal of version {version}, expected {VERSION}; "
                "use the release that wrote it, or move the file away to start with an empty queue"
            )
        if is_reader:
            if is_new:
                raise JournalError(f"{self.path}: is empty; no service has run with it")
            return
        self._execute("PRAGMA journal_mode = WAL")
        # Each commit waits for the disk: an acknowledged request survives the loss of power.
        self._execute("PRAGMA synchronous = FULL")
        self._execute("PRAGMA journal_size_limit = 4194304")
        self._execute(f"PRAGMA max_page_count = {self._limits.pages}")
        if is_new:
            self._create()
        problem = next(self._rows("PRAGMA quick_check(1)"))[0]
        if problem != "ok":
            raise sqlite3.DatabaseError(problem)
        for task_id, number in self._rows("SELECT id, number FROM task"):
            self._numbers[task_id] = number
        self._next_number = max(self._numbers.values(), default=0) + 1

    def _create(self) -> None:
        self._execute("BEGIN IMMEDIATE")
        for statement in filter(str.strip, SCHEMA.split(";")):
            self._execute(statement)
        self._execute(f"PRAGMA application_id = {APPLICATION}")
        self._execute(f"PRAGMA user_version = {VERSION}")
        self._execute("COMMIT")

    def _write(self, changes: Changes, next_number: int) -> None:
        for task in changes.tasks.values():
            number = self._numbers.get(task.id)
            if number is None:
                number = self._numbers[task.id] = self._next_number
                self._next_number += 1
            row = (task.id, number, task.status.value, task.finished_at, _body(task))
            self._execute("INSERT OR REPLACE INTO task VALUES (?, ?, ?, ?, ?)", *row)
        for name, state in changes.objects.items():
            self._execute("INSERT OR REPLACE INTO object VALUES (?, ?)", name, json.dumps(asdict(state)))
        for name, series in changes.series.items():
            if series is None:
                self._execute("DELETE FROM series WHERE id = ?", name)
            else:
                body = json.dumps(request_to_json(series.request))
                self._execute("INSERT OR REPLACE INTO series VALUES (?, ?, ?)", name, series.next_start, body)
        for entry in changes.log:
            query = "INSERT INTO log (stamp, kind, task, text) VALUES (?, ?, ?, ?)"
            self._execute(query, entry.stamp, entry.kind, entry.task, entry.text)
        if changes.robot is not None:
            self._put("robot", json.dumps(asdict(changes.robot)))
        self._put("next_number", str(next_number))
        self._prune(changes)

    def _put(self, name: str, value: str) -> None:
        self._execute("INSERT OR REPLACE INTO state VALUES (?, ?)", name, value)

    def _prune(self, changes: Changes) -> None:
        """Remove the oldest history."""
        if changes.log:
            query = "DELETE FROM log WHERE number <= (SELECT max(number) FROM log) - ?"
            self._execute(query, self._limits.log_entries)
        if any(not task.is_open for task in changes.tasks.values()):
            query = "SELECT id FROM task WHERE finished IS NOT NULL ORDER BY finished DESC LIMIT -1 OFFSET ?"
            for (task_id,) in list(self._rows(query, self._limits.ended_tasks)):
                self._execute("DELETE FROM task WHERE id = ?", task_id)
                self._numbers.pop(task_id, None)

    def _execute(self, statement: str, *values: Any) -> None:
        self._connection.execute(statement, values)

    def _rows(self, query: str, *values: Any) -> Iterator[Any]:
        with closing(self._connection.execute(query, values)) as cursor:
            yield from cursor.fetchall()

    def _error(self, error: Exception) -> JournalError:
        text = str(error)
        is_damaged = isinstance(error, (ValueError, LookupError, TypeError)) or "malformed" in text
        if is_damaged or "not a database" in text or "no such" in text:
            return JournalError(
                f"{self.path}: the journal is damaged ({text}); move it away to start with an empty queue, "
                "or restore it from a copy"
            )
        advice = {
            "readonly": "make the file and its folder writable, or name another folder with --state",
            "full": "free some space on the disk",
            "locked": "another service uses it; end that one, or name another folder with --state",
            "unable to open": "the folder must exist and be writable",
        }
        what = next((advice[key] for key in advice if key in text), "see the reason")
        return JournalError(f"{self.path}: the journal cannot be read or written ({text}); {what}")


def _locked(path: Path) -> IO[str]:
    """Lock a journal for one service; the lock ends with the process, however it ends."""
    lock = path.with_name(path.name + ".lock").open("w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.close()
        raise JournalError(
            f"{path}: another service uses this journal; end that one, or name another folder with --state"
        ) from None
    return lock


def _body(task: ServiceTask) -> str:
    values = {name: value for name, value in vars(task).items() if name not in ("id", "request", "estimate")}
    return json.dumps({**values, "status": task.status.value, "request": request_to_json(task.request)})


def _task(task_id: str, body: str) -> ServiceTask:
    values = json.loads(body)
    request, status = request_from_json(values.pop("request")), TaskStatus(values.pop("status"))
    return ServiceTask(task_id, request, status, **values)


def _object(body: str) -> ObjectState:
    values = json.loads(body)
    pose = values["pose"]
    return ObjectState(values["place"], None if pose is None else Pose2(**pose), values["carried_by"])


def _robot(body: str) -> RobotRecord:
    values = json.loads(body)
    return RobotRecord(values["stamp"], Pose2(**values["pose"]), values["is_docked"])
