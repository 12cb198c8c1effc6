"""Requests as a line of text: ``deliver cup from kitchen to desk``."""

import re
from typing import Any, Callable, Dict, List, Tuple

from planar.config.hints import hint_or_choices
from service.errors import RequestError
from service.requests.calendar_times import parse_duration

FORMS: Dict[str, Tuple[str, "re.Pattern[str]"]] = {
    "deliver": ("deliver OBJECT from PLACE to PLACE", re.compile(r"(.+?) from (.+?) to (.+)")),
    "fetch": ("fetch OBJECT to PLACE", re.compile(r"(.+?) to (.+)")),
    "bring": ("bring OBJECT to PLACE", re.compile(r"(.+?) to (.+)")),
    "find": ("find OBJECT", re.compile(r"(.+)")),
    "go": ("go PLACE", re.compile(r"(?:to )?(.+)")),
    "patrol": ("patrol PLACE PLACE ... [N times]", re.compile(r"(.+?)(?: (\d+) (?:times|rounds))?")),
    "wait": ("wait 5min [at PLACE]", re.compile(r"(.+?)(?: at (.+))?")),
    "dock": ("dock", re.compile(r"")),
}

# Verbs for categories that have other names.
SYNONYMS = {"bring": "fetch"}


def _patrol(places: str, rounds: str) -> Dict[str, Any]:
    names: List[str] = [word for word in re.split(r"[\s,]+", places) if word and word != "and"]
    return {"places": names, "rounds": int(rounds or 1)}


def _wait(duration: str, place: str) -> Dict[str, Any]:
    return {"seconds": parse_duration(duration), **({"place": place} if place else {})}


DESCRIBE: Dict[str, Callable[..., Dict[str, Any]]] = {
    "deliver": lambda name, source, to: {"object": name, "from": source, "to": to},
    "fetch": lambda name, to: {"object": name, "to": to},
    "find": lambda name: {"object": name},
    "go": lambda place: {"place": place},
    "patrol": _patrol,
    "wait": _wait,
    "dock": lambda: {},
}


def parse_text(text: str) -> Dict[str, Any]:
    """Convert a line of text to category and description of a request.

    Raises:
        RequestError: If it has none of the known forms.
    """
    words = text.split()
    verb = words[0].lower() if words else ""
    if verb not in FORMS:
        raise RequestError([f"text: '{verb}' is no request{hint_or_choices(verb, FORMS)}"])
    usage, pattern = FORMS[verb]
    match = pattern.fullmatch(" ".join(words[1:]))
    if match is None:
        raise RequestError([f"text: '{' '.join(words)[:200]}' is incomplete; expected: {usage}"])
    category = SYNONYMS.get(verb, verb)
    return {"category": category, "description": DESCRIBE[category](*match.groups())}
