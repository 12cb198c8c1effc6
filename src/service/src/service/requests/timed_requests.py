"""Requests that are sent at given times: those of a generated day, or of a file."""

import hashlib
import json
import math
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Deque, Dict, List, Sequence

from planar import SettingsError
from planar.files.reading import read_text
from planar.files.writing import write_atomically
from service.errors import QueueFullError, RequestError

# Key of a request's document in a file: when it is sent. Its name is that of Open-RMF's task schema.
TIME_KEY = "unix_millis_request_time"


@dataclass(frozen=True)
class TimedRequest:
    """A request and when it is sent.

    Attributes:
        stamp: Unix time [s].
        document: The request as JSON values.
    """

    stamp: float
    document: Dict[str, Any]


class RequestFeed:
    """Submits requests when their times come.

    Args:
        requests: The requests.
        submit: Called with a document and the Unix time [s]; may raise RequestError or QueueFullError.
        on_refused: Called with the reason why a request was refused.
    """

    def __init__(
        self,
        requests: Sequence[TimedRequest],
        submit: Callable[[Any, float], object],
        on_refused: Callable[[str], object],
    ):
        self._coming: Deque[TimedRequest] = deque(sorted(requests, key=lambda request: request.stamp))
        self._submit, self._on_refused = submit, on_refused

    @property
    def next_stamp(self) -> float:
        """Unix time of the next request [s]; infinity without one."""
        return self._coming[0].stamp if self._coming else math.inf

    def advance(self, now: float) -> None:
        """Submit the requests that have come by a Unix time [s]."""
        while self.next_stamp <= now:
            try:
                self._submit(self._coming.popleft().document, now)
            except (RequestError, QueueFullError) as error:
                self._on_refused(str(error))


def save_requests(path: Path, requests: Sequence[TimedRequest]) -> Path:
    """Write requests as a JSON list of documents, each with its time; return the path."""
    documents = [{TIME_KEY: round(1000.0 * each.stamp), **each.document} for each in requests]
    write_atomically(path, json.dumps(documents, indent=1).encode("utf-8"))
    return path


def load_requests(path: Path) -> List[TimedRequest]:
    """Read requests as ``save_requests`` writes them.

    Those without an id get one, by which a service that goes on accepts them once.

    Raises:
        SettingsError: The file cannot be read, or an entry has no time; the text names file and entry.
    """
    try:
        text = read_text(path)
        documents = json.loads(text)
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(f"{path}: is not valid JSON: {error}") from None
    if not isinstance(documents, list):
        raise SettingsError(f"{path}: expected a list of requests, got {type(documents).__name__}")
    prefix = f"requests-{hashlib.sha256(text.encode()).hexdigest()[:12]}"
    return [
        _request(f"{path}: request {number}", each, f"{prefix}-{number}")
        for number, each in enumerate(documents, 1)
    ]


def _request(where: str, document: Any, default_id: str) -> TimedRequest:
    if not isinstance(document, dict):
        raise SettingsError(f"{where}: expected a table of keys and values, got {type(document).__name__}")
    millis = document.pop(TIME_KEY, None)
    is_number = isinstance(millis, (int, float)) and not isinstance(millis, bool)
    if not is_number or not math.isfinite(millis):
        raise SettingsError(f"{where}: {TIME_KEY} must be when it is sent, a Unix time in ms, got {millis!r}")
    return TimedRequest(millis / 1000.0, {"id": default_id, **document})
