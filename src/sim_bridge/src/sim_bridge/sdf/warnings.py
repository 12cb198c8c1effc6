"""Collects warnings about content of a world that is ignored, one for each kind."""

from typing import Dict, Hashable, List, Tuple

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.supported import DOCK, IGNORED, REDUNDANT_PLUGINS, SUPPORTED, plugin_name


class SkippedElements:
    """Warnings about ignored elements.

    Args:
        strict: Treat missing files as errors.
    """

    def __init__(self, strict: bool = False):
        self._strict = strict
        self._lines: Dict[Hashable, Tuple[str, int]] = {}

    def skip(self, element: Element, why: str = "ignored", kind: Hashable = None) -> None:
        """Warn that an element is ignored.

        Args:
            element: The element.
            why: Text of the warning.
            kind: Warnings of one kind are merged; by default those of this tag, library and text.
        """
        library = element.attribute("filename")
        text = f"{element.file}: {element.place}{f' ({library})' if library else ''}: {why}"
        key = kind or (element.tag, element.attribute("type"), library, why)
        first, count = self._lines.get(key, (text, 0))
        self._lines[key] = (first, count + 1)

    def missing(self, element: Element, what: str, consequence: str = "ignored") -> None:
        """Warn that a file is missing.

        Args:
            element: Element that refers to the file.
            what: Which file is missing; warnings with the same text are merged.
            consequence: What is done instead.

        Raises:
            WorldError: Missing files are errors (``strict``).
        """
        if self._strict:
            raise element.error(what)
        self.skip(element, f"{what}, {consequence}", kind=what)

    def check_children(self, element: Element) -> None:
        """Warn about the children of an element that are not supported."""
        known = SUPPORTED[element.tag] | IGNORED.get(element.tag, frozenset())
        for child in element.children():
            if child.tag not in known and not (
                child.tag == "plugin" and plugin_name(child) in (*REDUNDANT_PLUGINS, DOCK)
            ):
                self.skip(child, kind=(element.tag, child.tag, child.attribute("filename")))

    def lines(self) -> List[str]:
        """Return one text for each kind of warning, with the number of further ones."""
        return [
            text + (f" (and {count - 1} more like it)" if count > 1 else "")
            for text, count in self._lines.values()
        ]
