"""Suggestions for misspelt names in error messages."""

import difflib
from typing import Iterable


def nearest_name(name: object, known: Iterable[str]) -> str:
    """Return the known name most similar to a given one.

    Args:
        name: The given name; YAML may have read it as a number.
        known: Valid names.

    Returns:
        The most similar valid name, or an empty string if none is similar.
    """
    matches = difflib.get_close_matches(str(name), list(known), n=1)
    return matches[0] if matches else ""


def hint(name: object, known: Iterable[str]) -> str:
    """Return the suggestion that ends an error message: `` (did you mean "crate"?)``, or nothing."""
    nearest = nearest_name(name, known)
    return f' (did you mean "{nearest}"?)' if nearest else ""


def hint_or_choices(name: object, known: Iterable[str]) -> str:
    """Return a suggestion as ``hint`` does, or all valid names if none is similar."""
    known = list(known)
    return hint(name, known) or f" (known: {', '.join(known)})"
