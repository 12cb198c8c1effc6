"""What somebody who wrote an unknown name may have meant."""

import difflib
from typing import Iterable


def nearest_name(name: object, known: Iterable[str]) -> str:
    """The known name most like ``name``, maybe a number of YAML; an empty string if none is alike."""
    matches = difflib.get_close_matches(str(name), list(known), n=1)
    return matches[0] if matches else ""


def hint(name: object, known: Iterable[str]) -> str:
    """What to put behind a complaint about ``name``: ", did you mean crate?", or nothing."""
    nearest = nearest_name(name, known)
    return f", did you mean {nearest}?" if nearest else ""


def hint_or_choices(name: object, known: Iterable[str]) -> str:
    """The same if it is few names that are known: "; did you mean crate?", or all of them."""
    known = list(known)
    nearest = nearest_name(name, known)
    return f"; did you mean {nearest}?" if nearest else f"; known are {', '.join(known)}"
