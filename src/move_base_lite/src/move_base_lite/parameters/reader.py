"""Settings read out of nested dictionaries of parameters."""

from typing import Any, Dict, Iterable, List, Mapping, Optional, Type, TypeVar

from move_base_lite.plugin import Plugin, Registry
from planar.config.hints import hint
from planar.config.parameters import parameters_of
from planar.config.settings import settings_from
from planar.plugins import PluginError

Tree = Mapping[str, Any]
T = TypeVar("T")
# In every namespace that has had a server of dynamic_reconfigure.
LEFT_BY_RECONFIGURE = "restore_defaults"


class ParameterReader:
    """Reads dataclasses out of nested dictionaries and collects what is odd."""

    def __init__(self, where: str, is_lenient: bool = False):
        self.where = where
        self.warnings: List[str] = []
        self._complain = self._pass_over if is_lenient else None

    def read(self, kind: Type[T], values: Tree, prefix: str, ignore: Iterable[str] = ()) -> T:
        """The settings ``kind`` from the values that are not dictionaries themselves."""
        flat = {
            name: value
            for name, value in values.items()
            if not isinstance(value, dict) and name not in ignore
        }
        said = parameters_of(kind)
        names = {**{each.field: each.field for each in said}, **{each.name: each.field for each in said}}
        settings, unknown = settings_from(kind, flat, names, self.where + prefix, self._complain)
        self.report_unknown(unknown, prefix, [*parameter_names(kind), *ignore])
        return settings

    def read_plugin(self, plugin: Plugin, values: Tree, prefix: str) -> Any:
        """The plugin's settings, also from old names and other ways to say the same."""
        present = dict(values)
        for old, new in plugin.deprecated.items():
            if old in present:
                self.warnings.append(f"parameter {self.where}{prefix}{old} is deprecated, use {new} instead")
                present.setdefault(new, present.pop(old))
        present = plugin.translate(renamed(present, plugin.synonyms))
        return self.read(plugin.settings, present, prefix, plugin.meaningless)

    def find(
        self, registry: Registry[T], name: str, key: str, is_package_needed: bool = True
    ) -> Optional[Plugin[T]]:
        """The plugin that the parameter ``key`` asks for. Raises PluginError if it cannot be used."""
        try:
            return registry.find(name, is_package_needed)
        except PluginError as error:
            raise PluginError(f"{self.where}{key}: {error}") from None

    def _pass_over(self, complaint: str) -> None:
        self.warnings.append(f"{complaint}: it counts as not set")

    def report_unknown(self, names: Iterable[str], prefix: str, known: Iterable[str]) -> None:
        known = list(known)
        for name in names:
            if name == LEFT_BY_RECONFIGURE:
                continue
            self.warnings.append(f"unknown parameter {self.where}{prefix}{name}{hint(name, known)}")


def subtree(parameters: Tree, name: str) -> Tree:
    value = parameters.get(name, {})
    return value if isinstance(value, dict) else {}


def renamed(values: Tree, names: Mapping[str, str]) -> Dict[str, Any]:
    return {names.get(name, name): value for name, value in values.items()}


def parameter_names(kind: type) -> List[str]:
    """The official names of the parameters of a settings dataclass."""
    return [each.name for each in parameters_of(kind)]
