"""Plugins: what can stand in one of the navigator's seams, by its official name.

A seam is a contract in a file of its own -- ``control/local_planner.py``, ``planning/global_planner.py``,
``recovery/behavior.py``, ``costmap/layer.py`` -- and beside it a ``registry.py`` that lists its members, one
line each. All else follows from a member's entry: how its parameters are read, what of them
dynamic_reconfigure offers, what ``config/move_base_lite.yaml`` says of them.
"""

from dataclasses import dataclass, field
from typing import Any, Callable, Dict, FrozenSet, Generic, Mapping, Optional, Tuple, TypeVar

from planar.config.parameters import Tunable, tunables_of

T = TypeVar("T")


def _as_they_are(values: Dict[str, Any]) -> Dict[str, Any]:
    return values


@dataclass(frozen=True)
class Plugin(Generic[T]):
    """A member of a seam.

    ``name``: the official one, package included. ``settings``: its dataclass, of parameters
    (planar.config.parameters). ``make``: its class; the contract says what it is called with.
    ``deprecated``: old names of its parameters and the present ones; honoured with a warning.
    ``synonyms``: other names that are as good. ``translated``: makes present values of old ways to say them.
    ``without_effect``: parameters that the official dynamic_reconfigure offers and that mean nothing here;
    ``ignored``: names that are known and mean nothing.
    """

    name: str
    settings: type
    make: Callable[..., T]
    deprecated: Mapping[str, str] = field(default_factory=dict)
    synonyms: Mapping[str, str] = field(default_factory=dict)
    translated: Callable[[Dict[str, Any]], Dict[str, Any]] = _as_they_are
    without_effect: Tuple[Tunable, ...] = ()
    ignored: FrozenSet[str] = frozenset()

    @property
    def short_name(self) -> str:
        """The name without its package: that of its namespace of parameters."""
        return short_name(self.name)

    @property
    def tunables(self) -> Tuple[Tunable, ...]:
        """What dynamic_reconfigure offers of it."""
        return (*tunables_of(self.settings), *self.without_effect)

    @property
    def meaningless(self) -> FrozenSet[str]:
        """Names of parameters that are known, but mean nothing here."""
        return self.ignored | {tunable.name for tunable in self.without_effect}

    def old_names(self, name: str) -> Tuple[str, ...]:
        """Other names under which a parameter may have been given."""
        return tuple(old for old, new in {**self.deprecated, **self.synonyms}.items() if new == name)


class Registry(Generic[T]):
    """The members of a seam; the first one takes the place of one that is not there."""

    def __init__(self, *members: Plugin[T]):
        self.members = members

    @property
    def names(self) -> Tuple[str, ...]:
        return tuple(member.name for member in self.members)

    def find(self, name: str, is_package_needed: bool = True) -> Optional[Plugin[T]]:
        """The member of that name; None if there is none. Without its package a name may be of any."""
        for member in self.members:
            if name == member.name or not is_package_needed and short_name(name) == member.short_name:
                return member
        return None

    def make(self, settings: Any, *given: Any) -> T:
        """A new object of the member that the settings are meant for; ``given``: as the contract says."""
        member = next(each for each in self.members if each.settings is type(settings))
        return member.make(settings, *given)


def short_name(name: str) -> str:
    """The name of a plugin without its package: ``pkg/Name``, or ``pkg::Name`` as of layers."""
    return name.replace("::", "/").rpartition("/")[2]
