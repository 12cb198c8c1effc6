"""Requests to the robot: what to do, when, how urgently, and for whom.

Names follow Open-RMF's task request (rmf_api_msgs: task_request.json): category, description, priority,
requester, labels, unix_millis_earliest_start_time. A deadline and repetition are additions.
"""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar, Dict, Mapping, Optional, Tuple, Type, Union

from service.requests.steps import Drive, DriveToObject, EnterDock, FindObject, Pause, PickUp, SetDown, Step

# Names of fields in JSON where they differ from the attributes.
JSON_NAMES = {"object_name": "object", "source": "from", "destination": "to"}


@dataclass(frozen=True)
class Deliver:
    """Carry an object from one place to another."""

    category: ClassVar[str] = "deliver"
    object_name: str
    source: str
    destination: str

    @property
    def text(self) -> str:
        return f"deliver {self.object_name} from {self.source} to {self.destination}"

    def steps(self) -> Tuple[Step, ...]:
        name = self.object_name
        return Drive(self.source), PickUp(name), Drive(self.destination), SetDown(name, self.destination)


@dataclass(frozen=True)
class Fetch:
    """Carry an object to a place, from where it is known to be, or is found."""

    category: ClassVar[str] = "fetch"
    object_name: str
    destination: str

    @property
    def text(self) -> str:
        return f"fetch {self.object_name} to {self.destination}"

    def steps(self) -> Tuple[Step, ...]:
        name = self.object_name
        return DriveToObject(name), PickUp(name), Drive(self.destination), SetDown(name, self.destination)


@dataclass(frozen=True)
class Find:
    """Find out where an object is."""

    category: ClassVar[str] = "find"
    object_name: str

    @property
    def text(self) -> str:
        return f"find {self.object_name}"

    def steps(self) -> Tuple[Step, ...]:
        return (FindObject(self.object_name),)


@dataclass(frozen=True)
class Go:
    """Drive to a place."""

    category: ClassVar[str] = "go"
    place: str

    @property
    def text(self) -> str:
        return f"go {self.place}"

    def steps(self) -> Tuple[Step, ...]:
        return (Drive(self.place),)


@dataclass(frozen=True)
class Patrol:
    """Drive to places in turn, several rounds (Open-RMF: patrol)."""

    category: ClassVar[str] = "patrol"
    places: Tuple[str, ...]
    rounds: int = 1

    @property
    def text(self) -> str:
        return f"patrol {' '.join(self.places)} {self.rounds} times"

    def steps(self) -> Tuple[Step, ...]:
        return tuple(map(Drive, self.places)) * self.rounds


@dataclass(frozen=True)
class Wait:
    """Stand for a time, at a place if one is named.

    Attributes:
        seconds: Duration [s].
        place: Where to wait; empty: where the robot is.
    """

    category: ClassVar[str] = "wait"
    seconds: float
    place: str = ""

    @property
    def text(self) -> str:
        return f"wait {self.seconds:g}s" + (f" at {self.place}" if self.place else "")

    def steps(self) -> Tuple[Step, ...]:
        return (*((Drive(self.place),) if self.place else ()), Pause(self.seconds))


@dataclass(frozen=True)
class GoToDock:
    """Drive into the dock."""

    category: ClassVar[str] = "dock"

    @property
    def text(self) -> str:
        return self.category

    def steps(self) -> Tuple[Step, ...]:
        return (EnterDock(),)


# Each has its steps, and its text, which is a request again.
Description = Union[Deliver, Fetch, Find, Go, Patrol, Wait, GoToDock]
DESCRIPTIONS: Mapping[str, Type[Any]] = {
    kind.category: kind for kind in (Deliver, Fetch, Find, Go, Patrol, Wait, GoToDock)
}


@dataclass(frozen=True)
class TaskRequest:
    """A valid request.

    Attributes:
        description: What to do.
        priority: 0 to MAX_PRIORITY, the most urgent.
        earliest_start: Unix time before which it must not be started [s]; None: at once.
        deadline: Unix time by which it is to be done [s]; None: none.
        request_time: Unix time of the request [s].
        repeat: Cron expression of its repetitions, in local time; empty: once.
        requester: Who asks for it.
        labels: Texts that are kept with it.
        after: Ids of tasks that must be completed before.
    """

    description: Description
    priority: int = 0
    earliest_start: Optional[float] = None
    deadline: Optional[float] = None
    request_time: float = 0.0
    repeat: str = ""
    requester: str = ""
    labels: Tuple[str, ...] = ()
    after: Tuple[str, ...] = ()

    @property
    def object_name(self) -> str:
        """Object that it moves or finds; empty if there is none."""
        return getattr(self.description, "object_name", "")

    @property
    def release(self) -> float:
        """Unix time from which on it may be worked on [s]."""
        return self.request_time if self.earliest_start is None else self.earliest_start


def request_to_json(request: TaskRequest) -> Dict[str, Any]:
    """Return a request as JSON values, without what is not set."""
    values = asdict(request.description)
    description = {JSON_NAMES.get(name, name): value for name, value in values.items() if value != ""}
    document: Dict[str, Any] = {
        "category": request.description.category,
        "description": description,
        "priority": {"type": "level", "value": request.priority},
        "unix_millis_request_time": to_millis(request.request_time),
        "unix_millis_earliest_start_time": to_millis(request.earliest_start),
        "unix_millis_deadline": to_millis(request.deadline),
        "repeat": request.repeat,
        "requester": request.requester,
        "labels": list(request.labels),
        "after": list(request.after),
    }
    return {name: value for name, value in document.items() if value not in (None, "", [])}


def request_from_json(document: Mapping[str, Any]) -> TaskRequest:
    """Return a request that ``request_to_json`` wrote; for what people send, see ``parse_request``."""
    return TaskRequest(
        description_from_json(document["category"], document["description"]),
        document["priority"]["value"],
        from_millis(document.get("unix_millis_earliest_start_time")),
        from_millis(document.get("unix_millis_deadline")),
        from_millis(document["unix_millis_request_time"]) or 0.0,
        document.get("repeat", ""),
        document.get("requester", ""),
        tuple(document.get("labels", ())),
        tuple(document.get("after", ())),
    )


def description_from_json(category: str, values: Mapping[str, Any]) -> Description:
    """Return what to do, from its category and its JSON values."""
    attributes = {name: attribute for attribute, name in JSON_NAMES.items()}
    found = {attributes.get(name, name): value for name, value in values.items()}
    if "places" in found:
        found["places"] = tuple(found["places"])
    description: Description = DESCRIPTIONS[category](**found)
    return description


def to_millis(seconds: Optional[float]) -> Optional[int]:
    """Convert Unix seconds to milliseconds; None stays None."""
    return None if seconds is None else round(1000.0 * seconds)


def from_millis(millis: Optional[int]) -> Optional[float]:
    """Convert Unix milliseconds to seconds; None stays None."""
    return None if millis is None else millis / 1000.0
