"""dynamic_reconfigure without compiled .cfg files: its parameters are the fields of a settings dataclass."""

import dataclasses
from types import SimpleNamespace
from typing import Any, Callable, Dict

from dynamic_reconfigure.server import Server

KINDS = {bool: "bool", int: "int", float: "double", str: "str"}
RESTORE = "restore_defaults"


class Reconfiguration:
    """Serves ``~set_parameters`` for the dynamic fields (planar.settings.parameter) of ``settings``.

    ``change(values)``, values by official name, is asked at each call and returns the values then in force.
    ``restore_defaults`` brings back those that the node was started with.
    """

    def __init__(self, settings: Any, change: Callable[[Dict[str, Any]], Dict[str, Any]]):
        self._change = change
        self._started_with = dynamic_values(settings)
        self._is_up = False
        self._server = Server(_description(settings), self._on_call)
        self._is_up = True

    def _on_call(self, config, level):
        if not self._is_up:  # the server's own first call, with what is on the parameter server
            config.update(self._started_with)
            return config
        asked = {name: config[name] for name in self._started_with}
        config.update(self._change(self._started_with if config[RESTORE] else asked))
        config[RESTORE] = False
        return config


def dynamic_values(settings: Any) -> Dict[str, Any]:
    """The values of the dynamic fields, by official name."""
    return {
        field.metadata["name"]: getattr(settings, field.name)
        for field in dataclasses.fields(settings)
        if field.metadata["dynamic"] is not None
    }


def _description(settings: Any) -> SimpleNamespace:
    """What dynamic_reconfigure's generator would have made of a .cfg file."""
    fields = [field for field in dataclasses.fields(settings) if field.metadata["dynamic"] is not None]
    parameters = [_parameter(field, getattr(settings, field.name)) for field in fields]
    parameters.append(_entry(RESTORE, False, "bring back the values of the start", False, True))
    group = {"name": "Default", "type": "", "state": True, "cstate": "true", "id": 0, "parent": 0}
    tables = {
        table: {parameter["name"]: parameter[key] for parameter in parameters}
        for table, key in (("min", "min"), ("max", "max"), ("defaults", "default"), ("level", "level"))
    }
    return SimpleNamespace(config_description={**group, "groups": [], "parameters": parameters}, **tables)


def _parameter(field, value) -> Dict[str, Any]:
    bounds, kind = field.metadata, type(field.default)
    low, high = "", ""
    if kind is bool:
        low, high = False, True
    elif kind is not str:
        # What the node was started with is offered too, however large.
        low, high = kind(bounds["low"]), kind(max(bounds["dynamic"], value))
    edit_method = ""
    if bounds["choices"]:
        options = [
            {"name": choice.replace("-", "_"), "type": "str", "value": choice, "description": choice}
            for choice in bounds["choices"]
        ]
        edit_method = repr({"enum": options, "enum_description": bounds["meaning"]})
    return _entry(bounds["name"], value, bounds["meaning"], low, high, edit_method)


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
