"""What was left out, told once a kind."""

from typing import Dict, Hashable, List, Tuple

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.supported import IGNORED, REDUNDANT_PLUGINS, SUPPORTED, plugin_name


class SkippedElements:
    """One line for each kind of thing left out, with how often. ``strict``: what is missing is an error."""

    def __init__(self, strict: bool = False):
        self._strict = strict
        self._lines: Dict[Hashable, Tuple[str, int]] = {}

    def skip(self, element: Element, why: str = "left out", kind: Hashable = None) -> None:
        """``kind``: things with the same one are told once; by default those of this tag and library."""
        library = element.attribute("filename")
        text = f"{element.file}: {element.place}{f' ({library})' if library else ''}: {why}"
        key = kind or (element.tag, element.attribute("type"), library, why)
        first, count = self._lines.get(key, (text, 0))
        self._lines[key] = (first, count + 1)

    def missing(self, element: Element, what: str, so: str = "left out") -> None:
        """A file that is not there. Raises WorldError if this is strict."""
        if self._strict:
            raise element.error(what)
        self.skip(element, f"{what}, {so}", kind=what)

    def check_children(self, element: Element) -> None:
        """Names the children of an element that are neither honoured nor without bearing."""
        known = SUPPORTED[element.tag] | IGNORED.get(element.tag, frozenset())
        for child in element.children():
            if child.tag not in known and not (
                child.tag == "plugin" and plugin_name(child) in REDUNDANT_PLUGINS
            ):
                self.skip(child, kind=(element.tag, child.tag, child.attribute("filename")))

    def lines(self) -> List[str]:
        return [
            text + (f" (and {count - 1} more like it)" if count > 1 else "")
            for text, count in self._lines.values()
        ]
