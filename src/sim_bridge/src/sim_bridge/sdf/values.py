"""Optional parameters of plugins: the child element's value, or a default."""

from sim_bridge.sdf.element import Element


def text(element: Element, tag: str, default: str) -> str:
    """Return the text of a child element; ``default`` if there is none or it is empty."""
    child = element.child(tag)
    return child.text if child is not None and child.text else default


def number(element: Element, tag: str, default: float) -> float:
    """Return a number. Raises WorldError if the text is not one."""
    child = element.child(tag)
    return child.numbers(1)[0] if child is not None else default


def length(element: Element, tag: str, default: float) -> float:
    """Return a positive number. Raises WorldError if the text is not one."""
    child = element.child(tag)
    return child.lengths(1)[0] if child is not None else default


def flag(element: Element, tag: str, default: bool) -> bool:
    """Return a truth value: ``1`` and ``true`` are true."""
    return element.flag(tag) if element.child(tag) is not None else default
