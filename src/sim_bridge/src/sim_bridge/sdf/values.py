"""Optional parameters of plugins: the value of a child element, or a default.

Each function takes the parent element, the child's tag, and the value that a missing child has.
"""

from sim_bridge.sdf.element import Element


def text(element: Element, tag: str, default: str) -> str:
    """Return the text of a child element; ``default`` if there is none or it is empty."""
    child = element.child(tag)
    return child.text if child is not None and child.text else default


def number(element: Element, tag: str, default: float) -> float:
    """Return a number.

    Raises:
        WorldError: The text is not a finite number.
    """
    child = element.child(tag)
    return child.numbers(1)[0] if child is not None else default


def length(element: Element, tag: str, default: float) -> float:
    """Return a positive number.

    Raises:
        WorldError: The text is not a positive number.
    """
    child = element.child(tag)
    return child.lengths(1)[0] if child is not None else default


def flag(element: Element, tag: str, default: bool) -> bool:
    """Return a truth value: ``1`` and ``true`` are true."""
    return element.flag(tag) if element.child(tag) is not None else default
