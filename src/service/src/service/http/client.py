"""Client of a service, without further packages."""

import json
import time
import urllib.error
import urllib.request
from contextlib import contextmanager
from http.client import HTTPException
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional

from planar import PlanarError
from planar.errors import SettingsError

ANSWER_SECONDS = 30.0
ADDRESS_FILE = "service.json"
# Statuses after which a request with an id may be sent again.
RETRY_STATUS = (429, 503, 507)


class RequestRefusedError(PlanarError):
    """The service has refused a request.

    Attributes:
        status: HTTP status.
        problems: Reasons.
    """

    def __init__(self, status: int, problems: List[str]):
        super().__init__("\n".join(problems))
        self.status, self.problems = status, problems


class ServiceClient:
    """Calls the service of a folder.

    Args:
        folder: Folder of the service, with the file ``service.json``.

    Raises:
        SettingsError: If no service runs there.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._url = self._token = ""
        self._read_address()

    def submit(self, document: Dict[str, Any], patience: float = 0.0) -> Dict[str, Any]:
        """Send a request; return its task.

        Args:
            document: The request.
            patience: Wall-clock time for which one with an ``id`` is sent again without an answer [s].

        Raises:
            RequestRefusedError: If it is refused.
            SettingsError: If the service does not answer.
        """
        deadline = time.monotonic() + patience
        while True:
            try:
                return self.call("POST", "/tasks", document)
            except (RequestRefusedError, SettingsError) as error:
                is_final = isinstance(error, RequestRefusedError) and error.status not in RETRY_STATUS
                if is_final or "id" not in document or time.monotonic() > deadline:
                    raise
            time.sleep(0.2)

    def call(self, method: str, path: str, document: Optional[Any] = None) -> Any:
        """Call a path; return its answer.

        Raises:
            RequestRefusedError: If the service refuses the call.
            SettingsError: If it does not answer.
        """
        with self._reporting_errors(), self._open(method, path, document) as answer:
            return json.load(answer)

    def events(self, after: Optional[int] = None) -> Iterator[Dict[str, Any]]:
        """Yield events as they happen.

        Args:
            after: Number of the last event that is known; None: only new ones.

        Raises:
            RequestRefusedError: If the service refuses the call.
            SettingsError: If it does not answer, or ends.
        """
        path = "/events" + ("" if after is None else f"?after={after}")
        with self._reporting_errors(), self._open("GET", path, None) as answer:
            for line in answer:
                if line.startswith(b"data: "):
                    yield json.loads(line[6:])

    def _open(self, method: str, path: str, document: Optional[Any]) -> Any:
        body = None if document is None else json.dumps(document).encode()
        self._read_address()
        headers = {"Authorization": f"Bearer {self._token}", "Content-Type": "application/json"}
        request = urllib.request.Request(self._url + path, body, headers, method=method)
        return urllib.request.urlopen(request, timeout=ANSWER_SECONDS)

    @contextmanager
    def _reporting_errors(self) -> Iterator[None]:
        """Turn errors of a call, also in the middle of an answer, into errors for users."""
        try:
            yield
        except urllib.error.HTTPError as error:
            raise RequestRefusedError(error.code, _problems(error)) from None
        except (OSError, ValueError, HTTPException) as error:
            reason = getattr(error, "reason", error)
            raise SettingsError(f"the service at {self._url} does not answer ({reason})") from None

    def _read_address(self) -> None:
        """Read the address again, as a restarted service has another one."""
        file = self._folder / ADDRESS_FILE
        try:
            document = json.loads(file.read_text(encoding="utf-8"))
            self._url, self._token = str(document["url"]), str(document["token"])
        except (OSError, ValueError, LookupError, TypeError):
            raise SettingsError(
                f"{file}: cannot be read; start ./scripts/service.sh, or name its folder with --state"
            ) from None


def _problems(error: urllib.error.HTTPError) -> List[str]:
    try:
        return [str(problem) for problem in json.load(error)["problems"]]
    except (OSError, ValueError, LookupError, TypeError):
        return [f"status {error.code}"]
