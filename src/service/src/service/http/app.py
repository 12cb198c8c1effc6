"""The HTTP application: state, tasks, history, events."""

import asyncio
import itertools
import json
from typing import Any, AsyncIterator, Dict, Optional

from fastapi import FastAPI, Request, Response
from fastapi.responses import JSONResponse, StreamingResponse

from planar import PlanarError
from service import host as calls
from service.errors import JournalError, QueueFullError, RequestError, TaskEndedError, UnknownTaskError
from service.http.schema import REQUEST_BODY
from service.requests.request import to_millis
from service.task_book import JournalEntry

MAX_BODY = 65_536
# Time until a call is answered [s], and between two signs of life of the stream of events.
ANSWER_SECONDS, ALIVE_SECONDS = 20.0, 15.0
# Events that wait for a slow client; then it is disconnected, and may resume by the last id that it received.
MAX_EVENTS_WAITING = 1000
STATUS = {
    RequestError: 422,
    QueueFullError: 429,
    UnknownTaskError: 404,
    TaskEndedError: 409,
    JournalError: 507,
}


class BodyError(PlanarError):
    """The body of a request is no JSON, or too long."""

    def __init__(self, status: int, text: str):
        super().__init__(text)
        self.status = status


class ServiceRoutes:
    """What the paths answer.

    Args:
        host: The service.
    """

    def __init__(self, host: calls.ServiceHost):
        self._host, self._numbers = host, itertools.count()

    async def get_state(self) -> Response:
        """What the robot does, its charge, and where objects are."""
        return await self._answer(calls.state())

    async def get_tasks(self) -> Response:
        """Open tasks in the order of the plan, and series."""
        return await self._answer(calls.tasks())

    async def post_task(self, request: Request) -> Response:
        """Accept a request: 201 with its task once it is in the journal;``in_time``: as planned."""
        return await self._answer(calls.submit(await json_of(request)), 201)

    async def get_task(self, task_id: str) -> Response:
        """A task that is open or has ended, or a series."""
        return await self._answer(calls.task(task_id))

    async def delete_task(self, task_id: str) -> Response:
        """Cancel a task or a series; a carried object is set down where the robot stands."""
        return await self._answer(calls.cancel(task_id))

    async def get_history(self, limit: int = 100) -> Response:
        """Tasks that have ended, the latest first."""
        return await self._answer(calls.history(max(1, min(limit, 10_000))))

    async def get_events(self, request: Request, after: Optional[int] = None) -> Response:
        """Server-sent events; ``after`` or the header Last-Event-ID resumes behind an event."""
        given = request.headers.get("last-event-id", "")
        since = int(given) if given.isdigit() else after
        stream = events(self._host, next(self._numbers), since)
        return StreamingResponse(stream, media_type="text/event-stream")

    async def _answer(self, act: calls.Act, status: int = 200) -> Response:
        try:
            answer = asyncio.wrap_future(self._host.call(act))
            return JSONResponse(await asyncio.wait_for(answer, ANSWER_SECONDS), status)
        except PlanarError as error:
            return problem_response(error)
        except asyncio.TimeoutError:
            text = f"no answer within {ANSWER_SECONDS:g} s; ask for the task's id to see if it was accepted"
            return JSONResponse({"problems": [text]}, 503)


def make_app(host: calls.ServiceHost, version: str) -> FastAPI:
    """Return the application for a service.

    Args:
        host: The service.
        version: Version of the interface.
    """
    app = FastAPI(title="Home service", version=version, docs_url=None, redoc_url=None)
    app.add_exception_handler(BodyError, on_body_error)
    routes = ServiceRoutes(host)
    app.add_api_route("/state", routes.get_state)
    app.add_api_route("/tasks", routes.get_tasks)
    app.add_api_route(
        "/tasks", routes.post_task, methods=["POST"], status_code=201, openapi_extra=REQUEST_BODY
    )
    app.add_api_route("/tasks/{task_id}", routes.get_task)
    app.add_api_route("/tasks/{task_id}", routes.delete_task, methods=["DELETE"])
    app.add_api_route("/history", routes.get_history)
    app.add_api_route("/events", routes.get_events)
    return app


async def on_body_error(_request: Request, error: Exception) -> Response:
    """Answer a request whose body is no JSON, or too long."""
    assert isinstance(error, BodyError)
    return problem_response(error)


def problem_response(error: PlanarError) -> Response:
    """Return the answer to a call that has failed."""
    status = error.status if isinstance(error, BodyError) else STATUS.get(type(error), 400)
    problems = list(error.problems) if isinstance(error, RequestError) else [str(error)]
    headers = {"retry-after": "10"} if status in (429, 507) else None
    return JSONResponse({"problems": problems}, status, headers)


async def json_of(request: Request) -> Any:
    """Return the body of a request.

    Raises:
        BodyError: If it is too long or no JSON.
    """
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > MAX_BODY:
            raise BodyError(413, f"a request has at most {MAX_BODY} bytes")
    try:
        return json.loads(body)
    except (ValueError, RecursionError) as error:
        raise BodyError(400, f"the body is no JSON ({type(error).__name__}: {str(error)[:200]})") from None


async def events(host: calls.ServiceHost, key: int, since: Optional[int]) -> AsyncIterator[str]:
    """Yield events as they happen, after those that the client has missed.

    Args:
        host: The service.
        key: Number of this stream.
        since: Number of the last event that the client received; None: only new ones.
    """
    loop = asyncio.get_running_loop()
    waiting: asyncio.Queue[str] = asyncio.Queue(MAX_EVENTS_WAITING)
    is_slow = asyncio.Event()

    def put(text: str) -> None:
        try:
            waiting.put_nowait(text)
        except asyncio.QueueFull:
            is_slow.set()

    def subscribe(host: calls.ServiceHost, _now: float) -> Any:
        assert host.journal is not None
        missed = [] if since is None else host.journal.log_after(since)
        host.listen(key, lambda number, entry: loop.call_soon_threadsafe(put, event_text(number, entry)))
        return lambda: missed

    try:
        for number, entry in await asyncio.wrap_future(host.call(subscribe)):
            yield event_text(number, entry)
        while not is_slow.is_set():
            try:
                yield await asyncio.wait_for(waiting.get(), ALIVE_SECONDS)
            except asyncio.TimeoutError:
                yield ": alive\n\n"
    finally:
        host.call(lambda host, _now: lambda: host.listen(key, None))


def event_text(number: int, entry: JournalEntry) -> str:
    """Return an event in the format of server-sent events."""
    data: Dict[str, Any] = {
        "unix_millis_time": to_millis(entry.stamp),
        "kind": entry.kind,
        "task": entry.task,
        "text": entry.text,
    }
    return f"id: {number}\nevent: {entry.kind}\ndata: {json.dumps(data)}\n\n"
