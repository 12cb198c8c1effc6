"""Values of plugins that may be left out."""

from sim_bridge.sdf.element import Element


def text(element: Element, tag: str, default: str) -> str:
    child = element.child(tag)
    return child.text if child is not None and child.text else default


def number(element: Element, tag: str, default: float) -> float:
    child = element.child(tag)
    return child.numbers(1)[0] if child is not None else default


def length(element: Element, tag: str, default: float) -> float:
    child = element.child(tag)
    return child.lengths(1)[0] if child is not None else default


def flag(element: Element, tag: str, default: bool) -> bool:
    return element.flag(tag) if element.child(tag) is not None else default
