"""Settings: frozen dataclasses filled from flat tables, with checks of names and types."""

import dataclasses
import math
import typing
import warnings
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Type, TypeVar, Union

from planar.errors import SettingsError

T = TypeVar("T")


def settings_from(
    kind: Type[T],
    values: Mapping[str, Any],
    names: Mapping[str, str] = {},
    where: Union[str, Callable[[str], str]] = "",
    on_error: Optional[Callable[[str], None]] = None,
) -> Tuple[T, List[str]]:
    """Fill a settings dataclass from named values; values that are missing keep their defaults.

    Old names of parameters are accepted with a FutureWarning if ``kind.DEPRECATED_PARAMETERS`` maps them to
    the fields that replace them.

    Args:
        kind: Settings dataclass.
        values: Values by official name.
        names: Official name -> field, for names that differ.
        where: Prefix of names in error messages, e.g. ``/amcl/``, or a function from name to prefix.
        on_error: Called with the message for a value of a wrong type, which then counts as not set; by
            default such a value is an error.

    Returns:
        The settings, and the names in ``values`` that ``kind`` does not have.

    Raises:
        SettingsError: For a value of a wrong type, or from ``kind.__post_init__`` for an invalid one.
    """
    location_of = where if callable(where) else lambda _name: where
    types = typing.get_type_hints(kind)
    fields = {field.name for field in dataclasses.fields(kind) if field.init}  # type: ignore[arg-type]
    renamed = set(names.values())
    deprecated: Mapping[str, str] = getattr(kind, "DEPRECATED_PARAMETERS", {})
    table = {**deprecated, **{name: name for name in fields if name not in renamed}, **names}
    known: Dict[str, Any] = {}
    unknown = []
    for name, value in values.items():
        if name not in table:
            unknown.append(name)
            continue
        if name in deprecated:
            text = f"{location_of(name)}{name} is deprecated; use {deprecated[name]}"
            warnings.warn(text, FutureWarning, stacklevel=2)
        try:
            known[table[name]] = _converted(types[table[name]], value, location_of(name) + name)
        except SettingsError as error:
            if on_error is None:
                raise
            on_error(str(error))
    try:
        return kind(**known), unknown
    except SettingsError as error:
        official = {field: name for name, field in table.items()}
        text = str(error)
        first = text.split(" ", 1)[0]
        name = official.get(first, first)
        raise SettingsError(location_of(name) + text.replace(first, name, 1)) from None


def check(condition: bool, name: str, requirement: str, value: Any) -> None:
    """Check a setting.

    Raises:
        SettingsError: ``<name> must be <requirement>, got <value>``, unless ``condition`` holds.
    """
    if not condition:
        raise SettingsError(f"{name} must be {requirement}, got {value!r}")


def _converted(kind: Any, value: Any, name: str) -> Any:
    if kind is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.nan
        if math.isnan(number):
            raise SettingsError(f"{name} must be a number, got {value!r}")
        return number
    if kind is int and isinstance(value, float) and value.is_integer():
        return int(value)
    if kind in (int, str, bool):
        if isinstance(value, kind) and not (kind is int and isinstance(value, bool)):
            return value
        if kind is bool and value in (0, 1):
            return bool(value)
    elif kind is not float:
        return value
    raise SettingsError(f"{name} must be {_KIND_NAMES[kind]}, got {value!r}")


_KIND_NAMES = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}
