"""Facts in what an observer reports: a path, and what is asked of the value."""

from typing import Any, Mapping


def fact_of(observed: Mapping[str, Any], fact: str) -> Any:
    """Return a fact.

    Args:
        observed: What an observer reports.
        fact: Keys and indices joined by dots, ``PATH has TEXT``, ``PATH < NUMBER``, ``PATH > NUMBER`` or
            ``PATH is known``.
    """
    path, _, question = fact.partition(" ")
    value: Any = observed
    for key in path.split("."):
        value = value[int(key) if isinstance(value, list) else key]
    if not question:
        return value
    how, _, operand = question.partition(" ")
    if how == "has":
        return operand in value
    if how == "is":
        return value is not None
    return value < float(operand) if how == "<" else value > float(operand)
