"""XML documents that know the line of each element, and which content has been read."""

import re
from typing import Dict, Hashable, Sequence, Set, Tuple
from xml.etree.ElementTree import TreeBuilder

import defusedxml.ElementTree
from defusedxml.common import DefusedXmlException

from sim_bridge.errors import WorldError

_VALUE_WITH_BRACKET = re.compile(r"""=(?:"[^"\n]*<[^"\n]*"|'[^'\n]*<[^'\n]*')""")
_VERSION_NUMBER = re.compile(r"[0-9]{1,9}$")


class Document:
    """An XML document.

    Args:
        file: Its name, for messages.
        root: Its root element.
        lines: Line of each element.

    Attributes:
        file: Its name, for messages.
        root: Its root element.
        version: SDF version, e.g. (1, 6).
    """

    def __init__(self, file: str, root, lines: Dict[Hashable, int]):
        self.file, self.root, self._lines = file, root, lines
        self.version = version_of(root.get("version", ""))
        self._read: Set[Hashable] = {root}

    def line(self, xml) -> int:
        """Return the line of an element."""
        return self._lines.get(xml, 0)

    def mark(self, xml) -> None:
        """Mark an element as read."""
        self._read.add(xml)

    def is_read(self, xml) -> bool:
        """Return whether an element has been read."""
        return xml in self._read


def parse_document(text, file: str, roots: Sequence[str]) -> Document:
    """Parse an XML text.

    Args:
        text: The XML, str or bytes.
        file: Name of the text, for messages.
        roots: Valid tags of the root.

    Raises:
        WorldError: The text is not well-formed, defines entities, or has another root.
    """
    try:
        root, lines = _parsed(text)
    except DefusedXmlException as error:
        raise WorldError(f"{file}: refused, defines entities ({type(error).__name__})") from None
    except (defusedxml.ElementTree.ParseError, ValueError) as error:
        raise WorldError(f"{file}: not well-formed XML ({error})") from None
    if root.tag not in roots:
        raise WorldError(f"{file}: its root is <{root.tag}>, expected <{roots[0]}>")
    return Document(file, root, lines)


class _LineRecorder(TreeBuilder):
    """Builds elements and records their lines."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: Dict[Hashable, int] = {}
        self.parser = defusedxml.ElementTree.DefusedXMLParser(target=self, forbid_dtd=False)

    def start(self, tag, attrs):
        element = super().start(tag, attrs)
        self.lines[element] = self.parser.parser.CurrentLineNumber
        return element


def _parsed(text):
    """Parse XML; like Gazebo's parser, accept a bare "<" in attributes."""
    try:
        return _parsed_strictly(text)
    except defusedxml.ElementTree.ParseError:
        lenient = text.decode("utf-8", "replace") if isinstance(text, bytes) else text
        lenient = _VALUE_WITH_BRACKET.sub(lambda match: match.group().replace("<", "&lt;"), lenient)
        if lenient == text:
            raise
        return _parsed_strictly(lenient)


def _parsed_strictly(text):
    recorder = _LineRecorder()
    recorder.parser.feed(text)
    return recorder.parser.close(), recorder.lines


def version_of(text: str) -> Tuple[int, ...]:
    """Return a version as a tuple of integers, so that 1.10 sorts after 1.9."""
    return tuple(int(number) if _VERSION_NUMBER.match(number) else 0 for number in text.split("."))
