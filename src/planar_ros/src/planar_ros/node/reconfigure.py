"""dynamic_reconfigure without compiled .cfg files: its parameters are tunables (planar.config.settings)."""

from types import SimpleNamespace
from typing import Any, Callable, Dict, Mapping, Sequence

from dynamic_reconfigure.encoding import extract_params
from dynamic_reconfigure.server import Server

from planar.config.parameters import DynamicParameter, dynamic_parameters_of, parameters_of
from planar_ros.node.parameters import RESTORE, ParameterWriter

KINDS = {bool: "bool", int: "int", float: "double", str: "str"}
LARGEST_INT = 2**31 - 1


class _Server(Server):
    """A server that talks to the parameter server once instead of once a parameter."""

    def _copy_from_parameter_server(self):
        """What the parameter server says is in the values in force already."""

    def _copy_to_parameter_server(self):
        names = [parameter["name"] for parameter in extract_params(self.type.config_description)]
        ParameterWriter().write({self.ns + name: self.config[name] for name in names})


class ReconfigureServer:
    """Serves ``set_parameters`` below ``namespace`` (default: the node's own) for some tunables.

    ``values``: those in force at the start, by name, which ``restore_defaults`` brings back.
    ``change(values)`` is asked at each call and returns the values then in force.
    """

    def __init__(
        self,
        tunables: Sequence[DynamicParameter],
        values: Mapping[str, Any],
        change: Callable[[Dict[str, Any]], Dict[str, Any]],
        namespace: str = "",
    ):
        self._change = change
        self._started_with = dict(values)
        self._is_up = False
        self._server = _Server(_description(tunables, values), self._on_call, namespace)

    def close(self) -> None:
        """Ends the service and its topics."""
        self._server.set_service.shutdown()
        self._server.descr_topic.unregister()
        self._server.update_topic.unregister()

    def _on_call(self, config, level):
        if (
            not self._is_up
        ):  # the server's own first call, before it serves any: what the parameter server says
            self._is_up = True
            config.update(self._started_with)
            return config
        asked = {name: config[name] for name in self._started_with}
        config.update(self._change(self._started_with if config[RESTORE] else asked))
        config[RESTORE] = False
        return config


class SettingsReconfigureServer(ReconfigureServer):
    """Serves ``~set_parameters`` for the dynamic fields of ``settings``."""

    def __init__(self, settings: Any, change: Callable[[Dict[str, Any]], Dict[str, Any]]):
        super().__init__(dynamic_parameters_of(type(settings)), dynamic_values(settings), change)


def dynamic_values(settings: Any) -> Dict[str, Any]:
    """The values of the dynamic fields, by official name."""
    return {
        each.name: getattr(settings, each.field)
        for each in parameters_of(type(settings))
        if each.dynamic is not None
    }


def _description(tunables: Sequence[DynamicParameter], values: Mapping[str, Any]) -> SimpleNamespace:
    """What dynamic_reconfigure's generator would have made of a .cfg file."""
    parameters = [_parameter(tunable, values[tunable.name]) for tunable in tunables]
    parameters.append(_entry(RESTORE, False, "bring back the values of the start", False, True))
    group = {"name": "Default", "type": "", "state": True, "cstate": "true", "id": 0, "parent": 0}
    tables = {
        table: {parameter["name"]: parameter[key] for parameter in parameters}
        for table, key in (("min", "min"), ("max", "max"), ("defaults", "default"), ("level", "level"))
    }
    return SimpleNamespace(config_description={**group, "groups": [], "parameters": parameters}, **tables)


def _parameter(tunable: DynamicParameter, value) -> Dict[str, Any]:
    kind = type(tunable.default)
    low: Any = ""
    high: Any = ""
    if kind is bool:
        low, high = False, True
    elif kind is not str:
        # What the node was started with is offered too, however large.
        low, high = _bound(kind, tunable.low), _bound(kind, max(tunable.high, value))
    edit_method = ""
    if tunable.choices:
        options = [
            {"name": choice.replace("-", "_"), "type": "str", "value": choice, "description": choice}
            for choice in tunable.choices
        ]
        edit_method = repr({"enum": options, "enum_description": tunable.meaning})
    return _entry(tunable.name, value, tunable.meaning, low, high, edit_method)


def _bound(kind, value: float):
    """A bound as a message can hold it."""
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
