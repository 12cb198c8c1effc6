"""XML elements with typed access, whose errors name the file and the element."""

import math
from pathlib import Path
from typing import Iterator, List, Optional, Sequence, Tuple

import numpy as np

from planar.files.reading import read_bytes
from planar.geometry.limits import MAX_COORDINATE, is_within
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import from_quaternion, pose3
from sim_bridge.sdf.document import Document, parse_document

# Bound of all numbers: above any that Gazebo writes, and small enough to be multiplied.
LARGEST = 1e30
# A larger number means no bound: Gazebo writes its largest one.
UNLIMITED = 1e15
TRUE = ("1", "true")
# Values of a pose's rotation_format.
EULER, QUATERNION = "euler_rpy", "quat_xyzw"
# Length that Gazebo replaces 0 by [m].
THINNEST = 1e-4


class Element:
    """An element of an SDF or URDF file, with typed access to its content.

    Methods that convert a text raise WorldError, which names the file and the element, if it is not valid.

    Children that are accessed by tag count as read (``Document``).

    Attributes:
        xml: The XML element.
        document: The document that it belongs to.
        tag: Tag of the element.
        name: Its attribute ``name``.
        place: Path of the element in the file, for errors.
    """

    def __init__(self, xml, document: Document, place: str = ""):
        self.xml = xml
        self.document = document
        self.tag: str = xml.tag
        self.name: str = xml.get("name", "")
        label = f"{self.tag} '{self.name}'" if self.name else self.tag
        self.place = f"{place} > {label}" if place else label

    @property
    def file(self) -> str:
        """Name of the file."""
        return self.document.file

    @property
    def version(self) -> Tuple[int, ...]:
        """SDF version of the file, e.g. (1, 6)."""
        return self.document.version

    def mark_all(self) -> None:
        """Mark the element and all below it as read."""
        for xml in self.xml.iter():
            self.document.mark(xml)

    @property
    def is_read(self) -> bool:
        """Whether the element has been accessed by its tag."""
        return self.document.is_read(self.xml)

    @property
    def where(self) -> str:
        """File, line and path of the element."""
        return f"{self.file}:{self.document.line(self.xml)}: {self.place}"

    def error(self, text: str) -> WorldError:
        """Return an error that names the file and the element."""
        return WorldError(f"{self.file}: {self.place}: {text}")

    def attribute(self, name: str) -> str:
        """Return an attribute, empty if there is none."""
        return self.xml.get(name, "")

    def children(self, tag: Optional[str] = None) -> Iterator["Element"]:
        """Yield the child elements, or those with a tag, which count as read then."""
        for xml in self.xml.iterfind(tag) if tag else self.xml:
            if isinstance(xml.tag, str):
                if tag:
                    self.document.mark(xml)
                yield Element(xml, self.document, self.place)

    def child(self, *path: str) -> Optional["Element"]:
        """Return the first element along a path of tags below this one; None if there is none."""
        element: Optional[Element] = self
        for tag in path:
            element = next(element.children(tag), None) if element else None
        return element

    def required(self, tag: str) -> "Element":
        """Return the first child with a tag.

        Raises:
            WorldError: There is none.
        """
        element = self.child(tag)
        if element is None:
            raise self.error(f"<{tag}> is missing")
        return element

    @property
    def text(self) -> str:
        """The text content without surrounding space."""
        return (self.xml.text or "").strip()

    def numbers(self, count: int) -> List[float]:
        """Return the text as exactly ``count`` finite numbers."""
        words = self.text.split()
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise self.error(f"expected {count} numbers, got {self.text!r}") from None
        if len(values) != count or not is_within(LARGEST, *values):
            raise self.error(f"expected {count} finite numbers, got {self.text!r}")
        return values

    def lengths(self, count: int) -> Tuple[float, ...]:
        """Return the text as ``count`` positive numbers."""
        return self._positive(self.numbers(count), "", self.text)

    def sizes(self, count: int) -> Tuple[float, ...]:
        """Return the text as ``count`` lengths of a shape, which may be 0 as in Gazebo."""
        return self._positive([value or THINNEST for value in self.numbers(count)], "", self.text)

    def attribute_numbers(
        self, name: str, count: int, default: Optional[Sequence[float]] = None
    ) -> Tuple[float, ...]:
        """Return an attribute as finite numbers.

        Commas between the numbers are accepted, as by Kinetic's urdfdom.

        Args:
            name: Name of the attribute.
            count: Exact number of values.
            default: Values of a missing attribute; None if it is required.

        Raises:
            WorldError: It is missing or not ``count`` finite numbers.
        """
        text = self.xml.get(name)
        if text is None and default is not None:
            return tuple(default)
        try:
            values = tuple(float(word) for word in (text or "").replace(",", " ").split())
        except ValueError:
            values = ()
        if len(values) != count or not is_within(LARGEST, *values):
            raise self.error(f"{name}: expected {count} finite numbers, got {text!r}")
        return values

    def attribute_sizes(self, name: str, count: int) -> Tuple[float, ...]:
        """Return an attribute as lengths of a shape, which may be 0 as in Gazebo.

        Args:
            name: Name of the attribute.
            count: Exact number of values.

        Raises:
            WorldError: It is missing, or not ``count`` numbers of at least 0.
        """
        values = [value or THINNEST for value in self.attribute_numbers(name, count)]
        return self._positive(values, f"{name} ", self.attribute(name))

    def _positive(self, values: Sequence[float], what: str, text: str) -> Tuple[float, ...]:
        if min(values) <= 0.0:
            raise self.error(f"{what}must be positive, got {text!r}")
        if max(values) > MAX_COORDINATE:
            raise self.error(f"{what}must be at most {MAX_COORDINATE:g}, got {text!r}")
        return tuple(values)

    def flag(self, tag: str) -> bool:
        """Return whether the child ``tag`` is true; False if there is none."""
        element = self.child(tag)
        return element is not None and element.text.lower() in TRUE

    def raw_pose(self) -> Optional[np.ndarray]:
        """Return the pose (4, 4) of this element's <pose>, in the frame that the <pose> names.

        Angles are in radians, or in degrees or a quaternion, if its attributes state it (SDF 1.9).

        Returns:
            The pose; None if there is no <pose>.
        """
        element = self.child("pose")
        if element is None or not element.text:
            return None
        rotation_format = element.attribute("rotation_format") or EULER
        if rotation_format not in (EULER, QUATERNION):
            raise element.error(f"rotation_format must be {EULER} or {QUATERNION}, got {rotation_format!r}")
        values = element.numbers(6 if rotation_format == EULER else 7)
        if not is_within(MAX_COORDINATE, *values):
            raise element.error(f"coordinates must be within {MAX_COORDINATE:g}, got {element.text!r}")
        if rotation_format == QUATERNION:
            if not any(values[3:]):
                raise element.error("the quaternion is zero")
            pose = from_quaternion(values[3:])
            pose[:3, 3] = values[:3]
            return pose
        if element.attribute("degrees").lower() in TRUE:
            values[3:] = map(math.radians, values[3:])
        return pose3(*values)

    def number(self, *path: str, default: float) -> float:
        """Return a number.

        Args:
            path: Tags from this element to the one with the number.
            default: The number if there is no such element.
        """
        element = self.child(*path)
        return element.numbers(1)[0] if element is not None else default

    def bound(self, *path: str, default: float) -> float:
        """Return a limit; a number that is too large for a limit becomes infinite.

        Args:
            path: Tags from this element to the one with the number.
            default: The limit if there is no such element.
        """
        element = self.child(*path)
        try:
            value = float(element.text) if element is not None else default
        except ValueError:
            value = math.nan
        if math.isnan(value) and element is not None:
            raise element.error(f"expected a number, got {element.text!r}")
        return value if abs(value) < UNLIMITED else math.copysign(math.inf, value)

    def count(self, *path: str, most: int, default: int) -> int:
        """Return an integer from 1 to a maximum.

        Args:
            path: Tags from this element to the one with the number.
            most: Largest valid number.
            default: The number if there is no such element.
        """
        element = self.child(*path)
        if element is None:
            return default
        (value,) = element.numbers(1)
        if value != int(value) or not 1 <= value <= most:
            raise element.error(f"must be a whole number from 1 to {most}, got {element.text!r}")
        return int(value)


def parse(path: Path) -> Element:
    """Return the root element of an SDF file.

    Raises:
        WorldError: The file cannot be read or is not SDF.
    """
    try:
        return parse_text(read_bytes(path), str(path))
    except OSError as error:
        raise WorldError(f"{path}: cannot be read ({error.strerror})") from None


def parse_text(text, file: str, roots: Sequence[str] = ("sdf", "gazebo")) -> Element:
    """Return the root element of an XML text.

    Args:
        text: The XML, str or bytes.
        file: Name of the text in errors.
        roots: Valid tags of the root.

    Raises:
        WorldError: The text is not well-formed, or has another root.
    """
    document = parse_document(text, file, roots)
    return Element(document.root, document)
