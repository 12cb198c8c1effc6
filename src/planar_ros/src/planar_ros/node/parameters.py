"""Parameters of a node: settings from the parameter server, and dynamic_reconfigure without .cfg files."""

import xmlrpc.client
from types import SimpleNamespace
from typing import Any, Callable, Dict, Iterable, Mapping, Sequence, Type, TypeVar

import rosgraph
import rospy
from dynamic_reconfigure.encoding import extract_params
from dynamic_reconfigure.server import Server

from planar import PlanarError, SettingsError
from planar.config.hints import hint
from planar.config.parameters import DynamicParameter, dynamic_parameters_of, parameters_of
from planar.config.settings import settings_from
from planar.config.without_effect import SettingsWithoutEffect, refuse, summary

# Parameter that dynamic_reconfigure adds to a node's parameters.
RESTORE = "restore_defaults"
# Parameter that makes an error of what has no effect.
STRICT = "strict_params"
# dynamic_reconfigure's names of types, and its largest integer.
KINDS = {bool: "bool", int: "int", float: "double", str: "str"}
LARGEST_INT = 2**31 - 1
T = TypeVar("T")


def read_settings(
    kind: Type[T],
    names: Mapping[str, str] = {},
    namespace: str = "~",
    ignore: Iterable[str] = (),
    defaults: Mapping[str, Any] = {},
    without_effect: Callable[[T], Mapping[str, str]] = lambda settings: {},
) -> T:
    """Read a settings dataclass from the parameter server (see planar.config.settings).

    Unknown names cause a warning with the most similar known name, and values of a wrong type count as not
    set, as in roscpp; if the node is strict both are errors. Nested namespaces belong to other components
    and are ignored.

    Args:
        kind: Settings dataclass.
        names: Official name -> field.
        namespace: Namespace of the parameters.
        ignore: Further known names.
        defaults: Values for parameters that are not set, instead of the defaults of ``kind``.
        without_effect: Returns for settings the names of parameters, fields of ``kind`` or not, that have
            no effect with them, with the reasons; they are named if they are set.

    Returns:
        The settings.

    Raises:
        SettingsError: With the full name of the parameter.
    """
    where = rospy.resolve_name(namespace).rstrip("/") + "/"
    values = {name: value for name, value in parameters_below(where).items() if not isinstance(value, dict)}
    settings, unknown = settings_from(kind, {**defaults, **values}, names, where, _report_wrong_type)
    ineffective = without_effect(settings)
    known = {*names, *kind.__dataclass_fields__, *ignore, *ineffective, STRICT, RESTORE}  # type: ignore[attr-defined]
    found = SettingsWithoutEffect()
    for name in sorted(ineffective.keys() & values.keys()):
        found.add(where + name, ineffective[name])
    unknown = [name for name in unknown if name not in known]
    unknown_texts = [f"unknown parameter {where}{name}{hint(name, known)}" for name in unknown]
    report_without_effect([*found], unknown_texts, is_strict())
    return settings


def is_strict() -> bool:
    """Whether ``strict_params`` is set for this node, in its namespace or one above."""
    place = rospy.search_param(STRICT)
    return bool(place is not None and rospy.get_param(place))


def report_without_effect(
    known: Sequence[str],
    unknown: Sequence[str],
    strict: bool,
    error: Type[PlanarError] = SettingsError,
    parameter: str = STRICT,
) -> None:
    """Log settings without effect and a summary; a strict node refuses them.

    Args:
        known: One sentence for each setting that is accepted without effect.
        unknown: One warning for each setting that is not known.
        strict: Whether the node refuses them.
        error: Class of the error.
        parameter: Parameter of the node that makes it strict.

    Raises:
        PlanarError: Of the class ``error``: the node is strict and there are such settings.
    """
    if strict:
        refuse([*unknown, *known], error)
    for text in known:
        rospy.loginfo("%s", text)
    for warning in unknown:
        rospy.logwarn("%s", warning)
    if known or unknown:
        rospy.logwarn("%s", summary(len(known) + len(unknown), f"~{parameter}"))


def parameters_below(namespace: str) -> Dict[str, Any]:
    """Return all parameters of a namespace as a nested dictionary; empty if there are none."""
    values = rospy.get_param(rospy.resolve_name(namespace).rstrip("/"), {})
    return values if isinstance(values, dict) else {}


class ParameterWriter:
    """Sets several parameters with one request to the master over a persistent connection; for one thread."""

    def __init__(self):
        self._master = xmlrpc.client.ServerProxy(rosgraph.get_master_uri())

    def write(self, values: Mapping[str, Any]) -> None:
        """Set parameters, given by name."""
        calls = xmlrpc.client.MultiCall(self._master)
        for name, value in values.items():
            calls.setParam(rospy.get_name(), rospy.resolve_name(name), value)
        calls()


class _Server(Server):
    """Server that writes all parameters with one request instead of one each."""

    def _copy_from_parameter_server(self):
        """Do nothing: the values already come from the parameter server."""

    def _copy_to_parameter_server(self):
        names = [parameter["name"] for parameter in extract_params(self.type.config_description)]
        ParameterWriter().write({self.ns + name: self.config[name] for name in names})


class ReconfigureServer:
    """Serves ``set_parameters`` of dynamic_reconfigure for some dynamic parameters."""

    def __init__(
        self,
        parameters: Sequence[DynamicParameter],
        values: Mapping[str, Any],
        change: Callable[[Dict[str, Any]], Dict[str, Any]],
        namespace: str = "",
    ):
        """Start the server.

        Args:
            parameters: Parameters.
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


def _report_wrong_type(complaint: str) -> None:
    """Report a value that counts as not set."""
    _report(f"{complaint}: it counts as not set")


def _report(text: str) -> None:
    if is_strict():
        raise SettingsError(text)
    rospy.logwarn("%s", text)


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
