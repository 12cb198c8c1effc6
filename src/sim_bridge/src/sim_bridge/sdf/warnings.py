"""Collects warnings about content of a world or robot that has no effect, one for each kind."""

from typing import AbstractSet, Dict, Hashable, Iterator, List, Sequence, Tuple

from planar.config.without_effect import refuse
from sim_bridge.errors import WorldError
from sim_bridge.sdf.element import TRUE, Element
from sim_bridge.sdf.supported import DEFAULTS, IGNORED, IRRELEVANT, REDUNDANT_PLUGINS, plugin_name

NO_EFFECT = "has no effect"


class SkippedElements:
    """Warnings about elements without effect.

    Args:
        strict: Treat missing files and elements without effect as errors.
    """

    def __init__(self, strict: bool = False):
        self._strict = strict
        self._lines: Dict[Hashable, Tuple[str, int]] = {}

    def skip(self, element: Element, why: str = NO_EFFECT, kind: Hashable = None) -> None:
        """Warn that an element, with all that it contains, has no effect.

        Args:
            element: The element.
            why: Text of the warning.
            kind: Warnings of one kind are merged; by default those of this tag, library and text.
        """
        element.mark_all()
        library = element.attribute("filename")
        text = f"{element.where}{f' ({library})' if library else ''}: {why}"
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

    def add_unread(self, root: Element, excluded: Sequence[Element] = ()) -> None:
        """Warn about the elements of a document that nothing has read.

        Args:
            root: The root of the document.
            excluded: Elements whose content is read later.
        """
        for parent, element in unread(root, {each.xml for each in excluded}):
            library = plugin_name(element) if element.tag == "plugin" else ""
            self.skip(element, kind=(parent.tag, element.tag, library))

    def lines(self) -> List[str]:
        """Return one text for each kind of warning, with the number of further ones.

        Raises:
            WorldError: There are warnings, and they are errors (``strict``); the text lists them.
        """
        lines = [
            text + (f" (and {count - 1} more like it)" if count > 1 else "")
            for text, count in self._lines.values()
        ]
        if self._strict:
            refuse(lines, WorldError)
        return lines


def unread(root: Element, excluded: AbstractSet[Hashable] = frozenset()) -> Iterator[Tuple[Element, Element]]:
    """Yield the outermost elements below ``root`` that nothing has read and that need a notice.

    Args:
        root: An element.
        excluded: XML elements that are skipped.

    Yields:
        The parent and the element.
    """
    for child in root.children():
        if child.xml in excluded:
            continue
        if child.tag in IRRELEVANT or child.tag in IGNORED.get(root.tag, ()) or _is_default(root, child):
            continue
        if child.tag == "plugin" and plugin_name(child) in REDUNDANT_PLUGINS:
            continue
        if child.is_read:
            yield from unread(child, excluded)
        elif not _is_empty(child):
            yield root, child


def _is_default(parent: Element, element: Element) -> bool:
    """Return whether an element has a value that asks for what happens anyway."""
    defaults = DEFAULTS.get(parent.tag, {}).get(element.tag, ())
    return bool(defaults) and _values(element.text) in map(_values, defaults)


def _is_empty(element: Element) -> bool:
    """Return whether an element states nothing, such as <bounce/>, or only defaults and what is ignored."""
    children = list(element.children())
    if element.tag in ("plugin", "sensor") or element.text or (element.xml.keys() and not children):
        return False
    return not any(True for _ in unread(element))


def _values(text: str) -> Tuple[float, ...]:
    """Return the numbers of a text; truth values count as 1 and 0."""
    try:
        return tuple(
            1.0
            if word.lower() in TRUE
            else 0.0
            if word.lower() == "false"
            else float(int(word, 0))
            if word.lower().startswith("0x")
            else float(word)
            for word in text.split()
        )
    except ValueError:
        return (float("nan"),)
