"""Settings from the parameter server."""

import xmlrpc.client
from typing import Any, Dict, Iterable, Mapping, Type, TypeVar

import rosgraph
import rospy

from planar import SettingsError
from planar.config.hints import hint
from planar.config.settings import settings_from

# Parameter that dynamic_reconfigure adds to a node's parameters.
RESTORE = "restore_defaults"
T = TypeVar("T")


def read_settings(
    kind: Type[T],
    names: Mapping[str, str] = {},
    namespace: str = "~",
    ignore: Iterable[str] = (),
    defaults: Mapping[str, Any] = {},
) -> T:
    """Read a settings dataclass from the parameter server (see planar.config.settings).

    Unknown names cause a warning with the most similar known name, and values of a wrong type count as not
    set, as in roscpp; with ``~strict_params`` both are errors. Nested namespaces belong to other components
    and are ignored.

    Args:
        kind: Settings dataclass.
        names: Official name -> field.
        namespace: Namespace of the parameters.
        ignore: Further known names.
        defaults: Values for parameters that are not set, instead of the defaults of ``kind``.

    Returns:
        The settings.

    Raises:
        SettingsError: With the full name of the parameter.
    """
    where = rospy.resolve_name(namespace).rstrip("/") + "/"
    values = {name: value for name, value in parameters_below(where).items() if not isinstance(value, dict)}
    settings, unknown = settings_from(kind, {**defaults, **values}, names, where, _report_wrong_type)
    known = {*names, *kind.__dataclass_fields__, *ignore, "strict_params", RESTORE}  # type: ignore[attr-defined]
    for name in unknown:
        if name not in known:
            _report(f"unknown parameter {where}{name}{hint(name, known)}")
    return settings


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


def _report_wrong_type(complaint: str) -> None:
    """Report a value that counts as not set."""
    _report(f"{complaint}: it counts as not set")


def _report(text: str) -> None:
    if rospy.get_param("~strict_params", False):
        raise SettingsError(text)
    rospy.logwarn("%s", text)
