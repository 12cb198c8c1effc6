"""Messages as YAML: a template, filled in as for rostopic pub and rosservice call."""

from io import BytesIO
from typing import Any, Callable, Optional, Type

import genpy
import roslib.message
import rospy
import yaml

from cockpit.errors import CockpitError
from planar.config.bounded_yaml import load_yaml
from rospy_transport.node import is_initialized

LONGEST = 20_000


def message_class(kind: str) -> Type[Any]:
    """Return the class of a message type.

    Raises:
        CockpitError: The type is not installed.
    """
    return _found(roslib.message.get_message_class, kind)


def service_class(kind: str) -> Type[Any]:
    """Return the class of a service type.

    Raises:
        CockpitError: The type is not installed.
    """
    return _found(roslib.message.get_service_class, kind)


def template(kind: Type[Any]) -> str:
    """Return all fields with their default values as YAML; empty without fields."""
    return genpy.message.strify_message(kind()).strip()


def filled(kind: Type[Any], text: str) -> Any:
    """Build a message from YAML.

    Args:
        kind: Class of the message.
        text: Its fields as YAML; ``now`` is the current time.

    Raises:
        CockpitError: The text does not match the type.
    """
    if len(text) > LONGEST:
        raise CockpitError(f"longer than {LONGEST} characters")
    message = kind()
    try:
        fields = load_yaml(text)
        if fields is not None and not isinstance(fields, (dict, list)):
            raise CockpitError("expected fields with values, such as 'data: 1.0'")
        if fields:
            now = rospy.get_rostime() if is_initialized() else rospy.Time()
            arguments = fields if isinstance(fields, list) else [fields]
            genpy.message.fill_message_args(message, arguments, {"now": now, "auto": _header(now)})
        message._check_types()
        message.serialize(BytesIO())  # genpy of Debian 11 checks floating-point numbers only here
    except yaml.YAMLError as error:
        where = getattr(error, "problem_mark", None)
        line = "" if where is None else f", line {where.line + 1}"
        raise CockpitError(f"not YAML{line}: {getattr(error, 'problem', error)}") from None
    except (genpy.MessageException, ValueError, TypeError, AttributeError, RecursionError) as error:
        raise CockpitError(f"not a {kind._type}: {error}") from None
    return message


def _header(now: Any) -> Any:
    return message_class("std_msgs/Header")(stamp=now)


def _found(find: Callable[[str], Optional[Type[Any]]], name: str) -> Type[Any]:
    try:
        kind = find(name)
    except ValueError:  # the name has no slash
        kind = None
    if kind is None:
        raise CockpitError(f"type {name} is not installed")
    return kind
