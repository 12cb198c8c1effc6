"""Validation of requests that people and programs send; all problems are reported at once."""

import math
from dataclasses import dataclass, field, fields
from datetime import tzinfo
from typing import Any, Callable, Collection, Dict, List, Mapping, Optional

from planar.config.hints import hint, hint_or_choices
from planar.maps.semantic_map import SemanticMap
from service.errors import RequestError
from service.requests.calendar_times import clock_text, next_repetition, parse_time
from service.requests.request import DESCRIPTIONS, JSON_NAMES, TaskRequest, from_millis
from service.requests.text import parse_text

MAX_PRIORITY, MAX_TEXT, MAX_LABELS, MAX_STEPS, MAX_WAIT = 9, 200, 20, 1000, 86400.0
# Times further away are mistakes, such as seconds for milliseconds [s].
MAX_AHEAD = 366 * 86400.0
# By how much a deadline may lie in the past: clocks differ [s].
TOLERANCE = 1.0
KEYS = (
    *("id", "category", "description", "text", "priority", "requester", "labels", "repeat", "after"),
    *("unix_millis_request_time", "unix_millis_earliest_start_time", "unix_millis_deadline"),
    *("by", "not_before"),
)


@dataclass(frozen=True)
class Knowledge:
    """What requests may refer to.

    Attributes:
        places: Names of places.
        has_dock: Whether there is a dock.
        semantic_map: What is usually where, to search objects by; None if nothing can be searched.
        zone: Time zone; None for that of the machine.
    """

    places: Collection[str]
    has_dock: bool = False
    zone: Optional[tzinfo] = None
    semantic_map: Optional[SemanticMap] = None

    def problem_with_search(self, object_name: str) -> str:
        """Return why an object cannot be searched, as a sentence; empty if it can."""
        if self.semantic_map is not None:
            return self.semantic_map.problem_with(object_name)
        return (
            f"it is not known where {object_name} is, and there is no semantic map to search it by; use "
            f"deliver {object_name} from PLACE to PLACE, or start the service with --home FOLDER"
        )


@dataclass
class RequestParser:
    """Converts a JSON document to a request.

    Attributes:
        known: What requests may refer to.
        now: Unix time [s].
        problems: Problems of the document found so far.
    """

    known: Knowledge
    now: float
    problems: List[str] = field(default_factory=list)

    def parse(self, document: Any) -> TaskRequest:
        """Return the request of a document.

        Raises:
            RequestError: With all problems.
        """
        if not isinstance(document, Mapping):
            raise RequestError([f"a request is a table of keys and values, not {type(document).__name__}"])
        for key in document:
            if key not in KEYS:
                self.problems.append(f'unknown key "{str(key)[:MAX_TEXT]}"{hint(key, KEYS)}')
        document = self._with_text(document)
        description = self._description(document)
        priority = self._priority(document.get("priority", 0))
        earliest = self._time(document, "unix_millis_earliest_start_time", "not_before")
        deadline = self._time(document, "unix_millis_deadline", "by")
        labels, after = (self._texts(key, document.get(key, [])) for key in ("labels", "after"))
        requester, repeat = self._text(document, "requester"), self._text(document, "repeat")
        self._text(document, "id")
        earliest = self._check_times(earliest, deadline, repeat)
        if self.problems:
            raise RequestError(self.problems)
        return TaskRequest(
            description, priority, earliest, deadline, self.now, repeat, requester, labels, after
        )

    def _with_text(self, document: Mapping[str, Any]) -> Mapping[str, Any]:
        if "text" not in document:
            return document
        if "category" in document or "description" in document:
            self.problems.append("text: expected either text, or category and description")
        try:
            return {**document, **parse_text(self._text(document, "text"))}
        except RequestError as error:
            raise RequestError([*self.problems, *error.problems]) from None

    def _description(self, document: Mapping[str, Any]) -> Any:
        category, values = document.get("category"), document.get("description", {})
        if not isinstance(category, str) or category not in DESCRIPTIONS:
            name = "is missing" if category is None else f'"{str(category)[:MAX_TEXT]}" is not known'
            self.problems.append(f"category: {name}{hint_or_choices(category, DESCRIPTIONS)}")
            return None
        if not isinstance(values, Mapping):
            self.problems.append("description: expected a table of keys and values")
            return None
        if category == "dock" and not self.known.has_dock:
            self.problems.append("category: there is no dock; place one with --dock or in the zones file")
        kind = DESCRIPTIONS[category]
        names = {JSON_NAMES.get(name, name): name for name in (item.name for item in fields(kind))}
        for key in values:
            if key not in names:
                self.problems.append(f'description: unknown key "{str(key)[:MAX_TEXT]}"{hint(key, names)}')
        read: Dict[str, Any] = {}
        for key, name in names.items():
            if key in values:
                read[name] = self._value(key, values[key])
            elif key not in ("rounds", "place") or (key == "place" and category == "go"):
                self.problems.append(f"description: {key} is missing")
        self._check_places(category, read)
        return None if self.problems else kind(**read)

    def _value(self, key: str, value: Any) -> Any:
        readers: Dict[str, Callable[[str, Any], Any]] = {
            "object": self._name,
            "from": self._place,
            "to": self._place,
            "place": self._place,
            "places": self._places,
            "rounds": lambda name, given: int(self._number(name, given, 1, MAX_STEPS, is_whole=True)),
            "seconds": lambda name, given: self._number(name, given, 0.0, MAX_WAIT),
        }
        return readers[key](key, value)

    def _check_places(self, category: str, read: Dict[str, Any]) -> None:
        if category == "deliver" and read.get("source") and read.get("source") == read.get("destination"):
            self.problems.append(f"description: to: expected another place than {read['source']}")
        if len(read.get("places", ())) * read.get("rounds", 1) > MAX_STEPS:
            self.problems.append(f"description: rounds: a patrol drives to at most {MAX_STEPS} places in all")

    def _name(self, key: str, value: Any) -> str:
        if not isinstance(value, str) or not value.strip() or len(value) > MAX_TEXT:
            self.problems.append(f"description: {key}: expected a name of at most {MAX_TEXT} characters")
            return ""
        return value

    def _place(self, key: str, value: Any) -> str:
        name = self._name(key, value)
        if name and name not in self.known.places:
            choices = hint_or_choices(name, self.known.places)
            self.problems.append(f'description: {key}: there is no place "{name}"{choices}')
        return name

    def _places(self, key: str, value: Any) -> Any:
        if not isinstance(value, list) or not value or len(value) > MAX_STEPS:
            self.problems.append(f"description: {key}: expected a list of 1 to {MAX_STEPS} places")
            return ()
        return tuple(self._place(key, name) for name in value)

    def _number(self, key: str, value: Any, low: float, high: float, is_whole: bool = False) -> float:
        is_number = isinstance(value, int) or (isinstance(value, float) and not is_whole)
        if isinstance(value, bool) or not is_number or not low <= value <= high:
            kind = "a whole number" if is_whole else "a number"
            self.problems.append(f"description: {key}: expected {kind} from {low:g} to {high:g}")
            return low
        return value

    def _priority(self, value: Any) -> int:
        if isinstance(value, Mapping):  # Open-RMF: {"type": ..., "value": ...}
            value = value.get("value")
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MAX_PRIORITY:
            self.problems.append(f"priority: expected a whole number from 0 to {MAX_PRIORITY}")
            return 0
        return value

    def _text(self, document: Mapping[str, Any], key: str) -> str:
        value = document.get(key, "")
        if not isinstance(value, str) or len(value) > MAX_TEXT:
            self.problems.append(f"{key}: expected a text of at most {MAX_TEXT} characters")
            return ""
        return value

    def _texts(self, key: str, value: Any) -> Any:
        is_list = isinstance(value, list) and len(value) <= MAX_LABELS
        if not is_list or any(not isinstance(each, str) or len(each) > MAX_TEXT for each in value):
            self.problems.append(f"{key}: expected at most {MAX_LABELS} texts of {MAX_TEXT} characters")
            return ()
        return tuple(value)

    def _time(self, document: Mapping[str, Any], key: str, text_key: str) -> Optional[float]:
        if text_key in document:
            if key in document:
                self.problems.append(f"{text_key}: expected either {text_key} or {key}")
            try:
                return parse_time(self._text(document, text_key), self.now, self.known.zone)
            except RequestError as error:
                self.problems += [f"{text_key}: {problem}" for problem in error.problems]
            return None
        value = document.get(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            self.problems.append(f"{key}: expected Unix milliseconds")
            return None
        seconds = from_millis(int(value)) if abs(value) < 1e15 else math.inf
        if seconds is None or abs(seconds - self.now) > MAX_AHEAD:
            self.problems.append(
                f"{key}: {value:.15g} ms is more than a year from now; expected Unix milliseconds"
            )
            return None
        return seconds

    def _check_times(
        self, earliest: Optional[float], deadline: Optional[float], repeat: str
    ) -> Optional[float]:
        """Return the earliest start: that of the first repetition if it is repeated."""
        if repeat:
            try:
                first = self.now if earliest is None else max(earliest, self.now)
                earliest = next_repetition(repeat, first - TOLERANCE, self.known.zone)
            except RequestError as error:
                self.problems += error.problems
        if deadline is not None and deadline < self.now - TOLERANCE:
            at = clock_text(deadline, self.known.zone)
            self.problems.append(f"deadline: {at} has passed; it is {clock_text(self.now, self.known.zone)}")
        elif deadline is not None and earliest is not None and deadline < earliest:
            at = clock_text(earliest, self.known.zone)
            self.problems.append(f"deadline: it is before the earliest start, {at}")
        return earliest


def parse_request(document: Any, known: Knowledge, now: float) -> TaskRequest:
    """Return the valid request of a JSON document.

    Args:
        document: What was sent: Open-RMF's task request, or ``text`` instead of category and description.
        known: What it may refer to.
        now: Unix time [s].

    Raises:
        RequestError: With all problems of the document.
    """
    return RequestParser(known, now).parse(document)
