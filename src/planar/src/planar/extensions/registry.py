"""The implementations of an extension point that a package ships, by their official names."""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Callable, Dict, FrozenSet, Generic, Mapping, Optional, Tuple, TypeVar

from planar.config.parameters import DynamicParameter, dynamic_parameters_of
from planar.config.without_effect import IneffectiveParameter
from planar.extensions.point import ExtensionPoint

T = TypeVar("T")


@dataclass(frozen=True)
class Plugin(Generic[T]):
    """A plugin of an extension point.

    Attributes:
        name: Official name with its package, as in ``dwa_local_planner/DWAPlannerROS``.
        settings: Dataclass of its parameters (planar.config.parameters).
        make: Its class; the contract states the arguments.
        deprecated: Old names of parameters with the present ones; accepted with a warning.
        synonyms: Other names of parameters with the present ones; accepted without a warning.
        translate: Converts old forms of parameter values to the present ones.
        without_effect: Official parameters that are accepted and have no effect here.
        elsewhere: Names of parameters that are read by other means.
    """

    name: str
    settings: type
    make: Callable[..., T]
    deprecated: Mapping[str, str] = field(default_factory=dict)
    synonyms: Mapping[str, str] = field(default_factory=dict)
    translate: Callable[[Dict[str, Any]], Dict[str, Any]] = lambda values: values
    without_effect: Tuple[IneffectiveParameter, ...] = ()
    elsewhere: FrozenSet[str] = frozenset()

    @property
    def short_name(self) -> str:
        """Name without the package, which is the namespace of its parameters."""
        return short_name(self.name)

    @property
    def tunables(self) -> Tuple[DynamicParameter, ...]:
        """Parameters that dynamic_reconfigure offers."""
        ineffective = (
            replace(each, meaning=f"(no effect: {each.meaning})")
            for each in self.without_effect
            if each.is_dynamic
        )
        return (*dynamic_parameters_of(self.settings), *ineffective)

    def old_names(self, name: str) -> Tuple[str, ...]:
        """Return the deprecated names and synonyms of a parameter.

        Args:
            name: Present name of the parameter.
        """
        return tuple(old for old, new in {**self.deprecated, **self.synonyms}.items() if new == name)


class Registry(Generic[T]):
    """The plugins of an extension point; the first is the default.

    Args:
        point: The extension point.
        members: Plugins of this package.
    """

    def __init__(self, point: ExtensionPoint[T], *members: Plugin[T]):
        self.point, self.members = point, members
        if point.parameter:
            _selected[point.package, point.parameter] = self
        self._loaded: Dict[str, Plugin[T]] = {}

    @property
    def names(self) -> Tuple[str, ...]:
        """Official names of the plugins of this package."""
        return tuple(member.name for member in self.members)

    @property
    def namespaces(self) -> Tuple[str, ...]:
        """Namespaces of the parameters of all plugins that are known so far."""
        return tuple(each.short_name for each in self._known)

    def find(self, name: str, is_package_needed: bool = True) -> Optional[Plugin[T]]:
        """Find a plugin by its name; a dotted name is that of a user-defined class.

        Args:
            name: Official name, entry point, or ``my_package.my_module/MyClass``.
            is_package_needed: Whether the package of an official name must be given.

        Returns:
            The plugin; None if there is none.

        Raises:
            PluginError: A user-defined class cannot be loaded or does not fulfil the contract.
        """
        if "." not in name.rpartition("/")[0]:
            for member in self.members:
                if name == member.name or not is_package_needed and short_name(name) == member.short_name:
                    return member
        return self._loaded.get(name) or self._load(name)

    def make(self, settings: Any, *given: Any) -> T:
        """Construct the plugin that belongs to given settings.

        Args:
            settings: Settings of the plugin; their type selects the plugin.
            given: Further arguments, as the contract states.
        """
        member = next(each for each in self._known if each.settings is type(settings))
        return member.make(settings, *given)

    @property
    def _known(self) -> Tuple[Plugin[T], ...]:
        return (*self.members, *self._loaded.values())

    def _load(self, name: str) -> Optional[Plugin[T]]:
        found = self.point.load(name)
        if found is not None:
            settings = self.point.settings_of(found)
            if any(each.settings is settings for each in self._known):  # the type selects the plugin
                settings = type(settings.__name__, (settings,), {"__doc__": settings.__doc__})
            self._loaded[name] = Plugin(
                name, settings, lambda *given: self.point.guarded(name, partial(found, *given))
            )
        return self._loaded.get(name)


_selected: Dict[Tuple[str, str], Registry[Any]] = {}


def registries_of(package: str) -> Dict[str, Registry[Any]]:
    """Return the registries from which a package selects a plugin, by the parameter that does."""
    return {
        parameter: _selected[owner, parameter] for owner, parameter in sorted(_selected) if owner == package
    }


class SelectedPlugins:
    """The plugins that a component uses, constructed at their first use.

    Args:
        settings: Settings of the selected plugins by the parameter that selects them; for any other, the
            first plugin of its registry is used.
    """

    def __init__(self, settings: Mapping[str, Any]):
        self._settings = settings
        self._made: Dict[str, Any] = {}

    def __getitem__(self, registry: Registry[T]) -> T:
        parameter = registry.point.parameter
        if parameter not in self._made:
            settings = self._settings.get(parameter) or registry.members[0].settings()
            self._made[parameter] = registry.make(settings)
        return self._made[parameter]


def short_name(name: str) -> str:
    """Return the name of a plugin, ``pkg/Name`` or ``pkg::Name``, without its package."""
    return name.replace("::", "/").rpartition("/")[2]
