"""Messages as people write them: a template in YAML, filled in as for rostopic pub and rosservice call."""

from io import BytesIO
from typing import Any, Callable, Optional, Type

import genpy
import roslib.message
import rospy
import yaml

from cockpit.errors import CockpitError

LONGEST = 20_000


def message_class(kind: str) -> Type[Any]:
    """Raises CockpitError if the type is not installed here."""
    return _found(roslib.message.get_message_class, kind)


def service_class(kind: str) -> Type[Any]:
    """Raises CockpitError if the type is not installed here."""
    return _found(roslib.message.get_service_class, kind)


def template(kind: Type[Any]) -> str:
    """Every field with the value that it has by itself; empty if there is none."""
    return genpy.message.strify_message(kind()).strip()


def filled(kind: Type[Any], text: str) -> Any:
    """A message of ``kind`` with what ``text`` says; ``now`` is the time now. Raises CockpitError."""
    if len(text) > LONGEST:
        raise CockpitError(f"longer than {LONGEST} characters")
    message = kind()
    try:
        fields = yaml.safe_load(text)
        if fields is not None and not isinstance(fields, (dict, list)):
            raise CockpitError("not fields with values, as 'data: 1.0'")
        if fields:
            now = rospy.get_rostime() if rospy.core.is_initialized() else rospy.Time()
            arguments = fields if isinstance(fields, list) else [fields]
            genpy.message.fill_message_args(message, arguments, {"now": now, "auto": _header(now)})
        message._check_types()
        message.serialize(BytesIO())  # genpy of Debian 11 looks at no floating-point number before
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
    except ValueError:  # of a name without a slash
        kind = None
    if kind is None:
        raise CockpitError(f"{name} is a type that is not installed here")
    return kind
