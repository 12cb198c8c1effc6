"""Plugins: what can stand in one of the navigator's seams, by its official name.

A seam is a contract in a file of its own -- ``control/local_planner.py``, ``planning/global_planner.py``,
``recovery/behavior.py``, ``costmap/layer.py`` -- and beside it a ``registry.py`` that lists its members, one
line each. All else follows from a member's entry: how its parameters are read, what of them
dynamic_reconfigure offers, what ``config/move_base_lite.yaml`` says of them.

A class of other people needs no line: it is known by its dotted name (planar.plugins). It is not trusted: a
``guarded.py`` beside the contract stands before it.
"""

from dataclasses import dataclass, field
from functools import partial
from typing import Any, Callable, Dict, FrozenSet, Generic, Mapping, Optional, Tuple, TypeVar

from planar.config.parameters import DynamicParameter, dynamic_parameters_of
from planar.plugins import PluginContract, load_plugin

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
    translate: Callable[[Dict[str, Any]], Dict[str, Any]] = _as_they_are
    without_effect: Tuple[DynamicParameter, ...] = ()
    ignored: FrozenSet[str] = frozenset()

    @property
    def short_name(self) -> str:
        """The name without its package: that of its namespace of parameters."""
        return short_name(self.name)

    @property
    def tunables(self) -> Tuple[DynamicParameter, ...]:
        """What dynamic_reconfigure offers of it."""
        return (*dynamic_parameters_of(self.settings), *self.without_effect)

    @property
    def meaningless(self) -> FrozenSet[str]:
        """Names of parameters that are known, but mean nothing here."""
        return self.ignored | {tunable.name for tunable in self.without_effect}

    def old_names(self, name: str) -> Tuple[str, ...]:
        """Other names under which a parameter may have been given."""
        return tuple(old for old, new in {**self.deprecated, **self.synonyms}.items() if new == name)


class Registry(Generic[T]):
    """The members of a seam; the first one takes the place of one that is not there.

    ``contract``: that other people's classes have to keep; ``guarded(name, make)`` stands before what
    ``make()`` gives, an object of theirs.
    """

    def __init__(
        self, *members: Plugin[T], contract: PluginContract, guarded: Callable[[str, Callable[[], T]], T]
    ):
        self.members = members
        self.contract = contract
        self._guarded = guarded
        self._loaded: Dict[str, Plugin[T]] = {}

    @property
    def names(self) -> Tuple[str, ...]:
        return tuple(member.name for member in self.members)

    def find(self, name: str, is_package_needed: bool = True) -> Optional[Plugin[T]]:
        """The member of that name; None if there is none. Without its package a name may be of any.

        A dotted name is that of other people's class. Raises PluginError if that cannot be used.
        """
        if "." not in name.rpartition("/")[0]:
            for member in self.members:
                if name == member.name or not is_package_needed and short_name(name) == member.short_name:
                    return member
        return self._loaded.get(name) or self._load(name)

    def make(self, settings: Any, *given: Any) -> T:
        """A new object of the member that the settings are meant for; ``given``: as the contract says."""
        known = (*self.members, *self._loaded.values())
        member = next(each for each in known if each.settings is type(settings))
        return member.make(settings, *given)

    def _load(self, name: str) -> Optional[Plugin[T]]:
        found = load_plugin(name, self.contract)
        if found is None:
            return None

        def make(*given: Any) -> T:
            return self._guarded(name, partial(found, *given))

        self._loaded[name] = Plugin(name, self.contract.settings_of(found), make)
        return self._loaded[name]


def short_name(name: str) -> str:
    """The name of a plugin without its package: ``pkg/Name``, or ``pkg::Name`` as of layers."""
    return name.replace("::", "/").rpartition("/")[2]
