"""dynamic_reconfigure servers for DynamicParameters (planar.config.parameters), without .cfg files."""

from types import SimpleNamespace
from typing import Any, Callable, Dict, Mapping, Sequence

from dynamic_reconfigure.encoding import extract_params
from dynamic_reconfigure.server import Server

from planar.config.parameters import DynamicParameter, dynamic_parameters_of, parameters_of
from planar_ros.node.parameters import RESTORE, ParameterWriter

KINDS = {bool: "bool", int: "int", float: "double", str: "str"}
LARGEST_INT = 2**31 - 1


class _Server(Server):
    """Server that writes all parameters with one request instead of one each."""

    def _copy_from_parameter_server(self):
        """Do nothing: the values already come from the parameter server."""

    def _copy_to_parameter_server(self):
        names = [parameter["name"] for parameter in extract_params(self.type.config_description)]
        ParameterWriter().write({self.ns + name: self.config[name] for name in names})


class ReconfigureServer:
    """Serves ``set_parameters`` for some dynamic parameters."""

    def __init__(
        self,
        parameters: Sequence[DynamicParameter],
        values: Mapping[str, Any],
        change: Callable[[Dict[str, Any]], Dict[str, Any]],
        namespace: str = "",
    ):
        """Start the server.

        Args:
            tunables: Parameters.
            values: Initial values by name, which ``restore_defaults`` restores.
            change: Called with the requested values; returns the values that are used.
            namespace: Namespace of the service; by default that of the node.
        """
        self._change = change
        self._initial = dict(values)
        self._is_up = False
        self._server = _Server(_description(parameters, values), self._on_call, namespace)

    def close(self) -> None:
        """Shut down the service and its topics."""
        self._server.set_service.shutdown()
        self._server.descr_topic.unregister()
        self._server.update_topic.unregister()

    def _on_call(self, config, level):
        if not self._is_up:  # the first call of the server itself: the values on the parameter server
            self._is_up = True
            config.update(self._initial)
            return config
        requested = {name: config[name] for name in self._initial}
        config.update(self._change(self._initial if config[RESTORE] else requested))
        config[RESTORE] = False
        return config


class SettingsReconfigureServer(ReconfigureServer):
    """Serves ``~set_parameters`` for the dynamic fields of a settings dataclass."""

    def __init__(self, settings: Any, change: Callable[[Dict[str, Any]], Dict[str, Any]]):
        super().__init__(dynamic_parameters_of(type(settings)), dynamic_values(settings), change)


def dynamic_values(settings: Any) -> Dict[str, Any]:
    """Return the values of the dynamic fields by official name."""
    return {
        each.name: getattr(settings, each.field)
        for each in parameters_of(type(settings))
        if each.dynamic is not None
    }


def _description(parameters: Sequence[DynamicParameter], values: Mapping[str, Any]) -> SimpleNamespace:
    """Return what dynamic_reconfigure's generator would make of a .cfg file."""
    entries = [_parameter(each, values[each.name]) for each in parameters]
    entries.append(_entry(RESTORE, False, "restore the initial values", False, True))
    group = {"name": "Default", "type": "", "state": True, "cstate": "true", "id": 0, "parent": 0}
    tables = {
        table: {entry["name"]: entry[key] for entry in entries}
        for table, key in (("min", "min"), ("max", "max"), ("defaults", "default"), ("level", "level"))
    }
    return SimpleNamespace(config_description={**group, "groups": [], "parameters": entries}, **tables)


def _parameter(parameter: DynamicParameter, value) -> Dict[str, Any]:
    kind = type(parameter.default)
    low: Any = ""
    high: Any = ""
    if kind is bool:
        low, high = False, True
    elif kind is not str:
        # The initial value is valid, however large.
        low, high = _bound(kind, parameter.low), _bound(kind, max(parameter.high, value))
    edit_method = ""
    if parameter.choices:
        options = [
            {"name": choice.replace("-", "_"), "type": "str", "value": choice, "description": choice}
            for choice in parameter.choices
        ]
        edit_method = repr({"enum": options, "enum_description": parameter.meaning})
    return _entry(parameter.name, value, parameter.meaning, low, high, edit_method)


def _bound(kind, value: float):
    """Return a limit that fits into a message."""
    return kind(min(max(value, -LARGEST_INT), LARGEST_INT) if kind is int else value)


def _entry(name, value, meaning, low, high, edit_method="") -> Dict[str, Any]:
    return {
        "name": name,
        "type": KINDS[type(value)],
        "default": value,
        "level": 1,
        "description": meaning,
        "min": low,
        "max": high,
        "edit_method": edit_method,
    }
