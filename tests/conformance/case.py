"""A statement about an official node as data: the same input for our node and for the official one."""

from dataclasses import dataclass, field
from typing import Any, Callable, Mapping


@dataclass(frozen=True)
class Same:
    """Marks that the official node gives what is expected of ours."""


SAME = Same()


@dataclass(frozen=True)
class Case:
    """One statement of the official source or documentation.

    Attributes:
        name: The statement as a test name, words joined by underscores.
        source: File of the official source, or page of the wiki, that states it.
        rig: Name of the rig that runs it (``RIGS`` of ``compare.py``).
        input: Input of the rig; plain values.
        expected: What our node gives.
        official: What the official node gives, if that differs on purpose.
        reason: Why it differs.
    """

    name: str
    source: str
    rig: str
    input: Mapping[str, Any]
    expected: Any
    official: Any = SAME
    reason: str = ""

    @property
    def expected_of_official(self) -> Any:
        """What the official node gives."""
        return self.expected if self.official is SAME else self.official


@dataclass(frozen=True)
class Rig:
    """Runs the cases of one interface.

    Attributes:
        ours: Returns what our node gives for an input.
        official: Returns what the official node gives; it may start nodes.
        needs: Official packages that must be installed to run the official node.
    """

    ours: Callable[[Mapping[str, Any]], Any]
    official: Callable[[Mapping[str, Any]], Any]
    needs: tuple = field(default_factory=tuple)
