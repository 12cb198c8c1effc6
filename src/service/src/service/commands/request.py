import os
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from supervision.command_line import argument, option


@dataclass(frozen=True)
class Request:
    """Send a request to the running service, or show, cancel and follow requests.

    Forms: deliver OBJECT from PLACE to PLACE; bring OBJECT to PLACE; find OBJECT; go PLACE;
    patrol PLACE PLACE ... [N times]; wait 5min [at PLACE]; dock. Without one, the open requests are listed.

    Exit code: 0 success, 1 a request that is followed has failed or was late, 2 invalid input or no service.
    """

    words: Tuple[str, ...] = argument("the request", default=(), nargs="*", metavar="REQUEST")
    by: Optional[str] = option(None, "deadline: 18:00, +30min or 2026-11-30T18:00", metavar="TIME")
    not_before: Optional[str] = option(None, "earliest start, in the same forms", metavar="TIME")
    priority: int = option(0, "0 to 9, the most urgent", type=int)
    repeat: Optional[str] = option(None, "cron expression, as '0 8 * * 1-5'", metavar="CRON")
    requester: Optional[str] = option(None, "who asks (default: the user's name)", metavar="NAME")
    mission: Optional[Path] = option(None, "send the deliveries of a mission file", type=Path)
    cancel: Optional[str] = option(None, "cancel this task or series", metavar="ID")
    wait: bool = option(False, "follow the request until it has ended")
    state: Path = option(Path("runs/service"), "folder of the service", type=Path, metavar="FOLDER")

    def run(self) -> int:
        from service.http.client import ServiceClient

        client = ServiceClient(self.state)
        if self.cancel is not None:
            client.call("DELETE", f"/tasks/{self.cancel}")
            print(f"{self.cancel} is canceled")
            return 0
        documents = self._documents()
        if not documents:
            return list_open(client)
        ids = [self._submit(client, document) for document in documents]
        return _follow(client, ids) if self.wait else 0

    def _documents(self) -> List[Dict[str, Any]]:
        from pick_objects import load_mission
        from service.requests.mission_requests import documents_of

        options: Dict[str, Any] = {
            "by": self.by,
            "not_before": self.not_before,
            "repeat": self.repeat,
            "requester": self.requester or os.environ.get("USER") or "terminal",
        }
        given = {name: value for name, value in options.items() if value is not None}
        if self.priority:
            given["priority"] = self.priority
        # By its id, a request whose answer is lost is sent again and accepted once.
        name = f"r-{uuid.uuid4().hex[:12]}"
        documents: List[Dict[str, Any]] = []
        if self.mission is not None:
            documents = documents_of(load_mission(self.mission), name)
        if self.words:
            documents.append({"text": " ".join(self.words), "id": name})
        return [{**document, **given} for document in documents]

    def _submit(self, client: Any, document: Dict[str, Any]) -> str:
        from service.requests.calendar_times import clock_text

        task = client.submit(document, patience=10.0)
        name = task["booking"]["id"]
        end = task.get("unix_millis_expected_finish_time")
        when = f", planned to be done at {clock_text(end / 1000.0)}" if end else ""
        print(f"{name}: {task['status']}{when}")
        if task.get("in_time") is False:
            print(f"warning: {name}: its deadline cannot be kept")
        return str(name)


def list_open(client: Any) -> int:
    """Print what the robot does and what is open; returns the exit code."""
    from service.requests.request import description_from_json

    state = client.call("GET", "/state")
    charge = "" if state["charge"] is None else f", charge {100.0 * state['charge']:.0f} %"
    print(f"{state['activity']}{charge}, {state['open']} open")
    for task in client.call("GET", "/tasks"):
        text = description_from_json(task["category"], task["detail"]).text
        late = "  late" if task.get("in_time") is False else ""
        print(f"{task['booking']['id']:>16}  {task['status']:<9} {text}{late}")
    return 0


def _follow(client: Any, ids: List[str]) -> int:
    open_ids = set(ids)
    is_good = True
    tasks = {name: client.call("GET", f"/tasks/{name}") for name in ids}
    for event in client.events(after=0):
        if event["task"] in open_ids:
            print(f"{event['task']}: {event['text']}", flush=True)
            if event["kind"] == "ended":
                open_ids.remove(event["task"])
        if not open_ids:
            break
    for name in tasks:
        task = client.call("GET", f"/tasks/{name}")
        is_good = is_good and task["status"] == "completed" and task.get("in_time") is not False
    return 0 if is_good else 1
