"""Reading of settings from nested dictionaries of parameters."""

from typing import Any, Container, Dict, Iterable, List, Mapping, Optional, Set, Type, TypeVar

from planar.config.hints import hint
from planar.config.parameters import parameters_of
from planar.config.settings import settings_from
from planar.config.without_effect import SettingsWithoutEffect
from planar.extensions import Plugin, PluginError, Registry

Tree = Mapping[str, Any]
T = TypeVar("T")
# Parameter that a server of dynamic_reconfigure leaves in its namespace.
LEFT_BY_RECONFIGURE = "restore_defaults"


class ParameterReader:
    """Reads settings from nested dictionaries; collects warnings and settings without effect.

    Args:
        where: Prefix of parameter names in messages.
        is_lenient: Whether a value of a wrong type is ignored with a warning instead of refused.

    Attributes:
        warnings: Warnings so far.
        unknown: Warnings about unknown parameters among them.
        without_effect: Parameters that are known and have no effect.
    """

    def __init__(self, where: str, is_lenient: bool = False):
        self.where = where
        self.unknown: List[str] = []
        self.without_effect = SettingsWithoutEffect()
        self.warnings: List[str] = []
        self._on_invalid = self._ignore_value if is_lenient else None

    def read(self, kind: Type[T], values: Tree, prefix: str, ignore: Iterable[str] = ()) -> T:
        """Read settings from the values that are not dictionaries themselves.

        Args:
            kind: Dataclass of the settings.
            values: Parameters by name.
            prefix: Namespace of the parameters, for messages.
            ignore: Names of parameters that are read by other means.

        Raises:
            SettingsError: A value is invalid.
        """
        flat = {
            name: value
            for name, value in values.items()
            if not isinstance(value, dict) and name not in ignore
        }
        declared = parameters_of(kind)
        names = {
            **{each.field: each.field for each in declared},
            **{each.name: each.field for each in declared},
        }
        settings, unknown = settings_from(kind, flat, names, self.where + prefix, self._on_invalid)
        self.report_unknown(unknown, prefix, [*parameter_names(kind), *ignore])
        return settings

    def read_plugin(self, plugin: Plugin, values: Tree, prefix: str) -> Any:
        """Read the settings of a plugin, also from deprecated names, synonyms and old forms of values.

        Args:
            plugin: The plugin.
            values: Parameters by name.
            prefix: Namespace of the parameters, for messages.

        Raises:
            SettingsError: A value is invalid.
        """
        present = dict(values)
        for old, new in plugin.deprecated.items():
            if old in present:
                self.warnings.append(f"parameter {self.where}{prefix}{old} is deprecated, use {new} instead")
                present.setdefault(new, present.pop(old))
        present = plugin.translate(renamed(present, plugin.synonyms))
        ineffective = self.take_ineffective(plugin, present, prefix)
        return self.read(plugin.settings, present, prefix, {*plugin.elsewhere, *ineffective})

    def read_ignored(self, plugin: Plugin, values: Tree, prefix: str) -> None:
        """Report the values of a namespace from which a plugin reads nothing.

        Args:
            plugin: The plugin.
            values: Parameters by name.
            prefix: Namespace of the parameters, for messages.
        """
        known = self.take_ineffective(plugin, values, prefix)
        self.report_unknown(set(values) - known, prefix, known)

    def take_ineffective(self, plugin: Plugin, values: Tree, prefix: str) -> Set[str]:
        """Add the values of a plugin's parameters without effect; return the names of these parameters.

        Args:
            plugin: The plugin.
            values: Parameters by name.
            prefix: Namespace of the parameters.
        """
        for each in plugin.without_effect:
            if each.name in values and not each.is_fulfilled_by(values[each.name]):
                self.without_effect.add(f"{self.where}{prefix}{each.name}", each.meaning)
        return {each.name for each in plugin.without_effect}

    def find(
        self, registry: Registry[T], name: str, key: str, is_package_needed: bool = True
    ) -> Optional[Plugin[T]]:
        """Find the plugin that a parameter selects (see Registry.find).

        Args:
            registry: Plugins to select from.
            name: Value of the parameter.
            key: Name of the parameter, for messages.
            is_package_needed: Whether the package of an official name must be given.

        Raises:
            PluginError: A user-defined class cannot be loaded or does not fulfil the contract.
        """
        try:
            return registry.find(name, is_package_needed)
        except PluginError as error:
            raise PluginError(f"{self.where}{key}: {error}") from None

    def _ignore_value(self, message: str) -> None:
        self.warnings.append(f"{message}: it counts as not set")

    def report_unknown(self, names: Iterable[str], prefix: str, known: Iterable[str]) -> None:
        """Add a warning for each unknown parameter, with the known name it resembles.

        Args:
            names: Names of unknown parameters.
            prefix: Namespace of the parameters, for messages.
            known: Names of known parameters.
        """
        known = list(known)
        for name in names:
            if name == LEFT_BY_RECONFIGURE:
                continue
            self.unknown.append(f"unknown parameter {self.where}{prefix}{name}{hint(name, known)}")
            self.warnings.append(self.unknown[-1])

    def report_unused(self, values: Tree, prefix: str, used: Container[str], reason: str) -> None:
        """Add the nested namespaces that nothing reads to the settings without effect.

        Args:
            values: Parameters by name.
            prefix: Their namespace, for messages.
            used: Names of the nested namespaces that are read.
            reason: Why the others are not.
        """
        for name, value in values.items():
            if isinstance(value, dict) and name not in used:
                self.without_effect.add(f"{self.where}{prefix}{name}", reason)


def subtree(parameters: Tree, name: str) -> Tree:
    """Return the parameters in a namespace; empty if there are none."""
    value = parameters.get(name, {})
    return value if isinstance(value, dict) else {}


def renamed(values: Tree, names: Mapping[str, str]) -> Dict[str, Any]:
    """Rename parameters.

    Args:
        values: Parameters by name.
        names: New names by old ones.
    """
    return {names.get(name, name): value for name, value in values.items()}


def parameter_names(kind: type) -> List[str]:
    """Official names of the parameters of a settings dataclass."""
    return [each.name for each in parameters_of(kind)]
