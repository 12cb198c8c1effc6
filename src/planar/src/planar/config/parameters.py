"""Parameters: fields of settings dataclasses with official name, unit, bounds and meaning.

The dataclass is the only place where a parameter is described; lists of parameters are generated from it
(planar.config.config_file)::

    @dataclass(frozen=True)
    class TeaSettings:
        minutes: float = parameter(3.0, "brewing time", "min", POSITIVE)
        kind: str = parameter("green", "kind of tea", choices=("green", "black"), name="tea_type")

        def __post_init__(self):
            check_parameters(self)
"""

import dataclasses
import math
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple, Type, TypeVar, Union

from planar.config.settings import check, settings_from
from planar.config.yaml_table import read_table
from planar.deprecation import deprecated_names

Dynamic = Union[None, bool, float, Tuple[float, float]]


class Interval(NamedTuple):
    """Interval of valid numbers.

    Attributes:
        low: Smallest valid value.
        high: Largest valid value.
        words: Description for error messages, e.g. ``positive``; generated from the limits if empty.
        exclusive_low: Whether ``low`` itself is invalid.
    """

    low: float = -math.inf
    high: float = math.inf
    words: str = ""
    exclusive_low: bool = False

    def __contains__(self, value: object) -> bool:
        assert isinstance(value, (int, float))
        return self.low <= value <= self.high and not (self.exclusive_low and value == self.low)

    def __str__(self) -> str:
        return self.words or f"between {self.low:g} and {self.high:g}"


POSITIVE = Interval(0.0, words="positive", exclusive_low=True)
ZERO_OR_MORE = Interval(0.0, words="zero or more")


def at_least(low: float) -> Interval:
    """Return the interval from ``low`` on."""
    return Interval(low, words=f"at least {low:g}")


@dataclasses.dataclass(frozen=True)
class Parameter:
    """Description of a parameter.

    Attributes:
        name: Official name.
        default: Default value.
        meaning: One line for people.
        unit: Unit, e.g. ``m/s``.
        bounds: Valid numbers.
        choices: Valid texts, if only some are valid.
        required: What the value must be, e.g. ``the path of a file``, if it has no default; ``default`` then
            means "not set".
        dynamic: None if dynamic_reconfigure cannot change it; True if it can; a number for the upper limit
            that dynamic_reconfigure offers, a pair for both limits.
        heading: Line above the parameter in generated lists.
        field: Field of the settings dataclass; empty outside one.
    """

    name: str
    default: Any
    meaning: str
    unit: str = ""
    bounds: Interval = Interval()
    choices: Tuple[str, ...] = ()
    required: str = ""
    dynamic: Dynamic = None
    heading: str = ""
    field: str = ""

    @property
    def meaning_and_choices(self) -> str:
        """Meaning, followed by the choices unless it names all of them."""
        if all(choice in self.meaning for choice in self.choices):
            return self.meaning
        return f"{self.meaning}: {', '.join(self.choices)}"

    def with_default(self, default: Any) -> "Parameter":
        """Return the same parameter with another default."""
        return dataclasses.replace(self, default=default)


def parameter(
    default: Any,
    meaning: str,
    unit: str = "",
    bounds: Interval = Interval(),
    *,
    name: str = "",
    choices: Sequence[str] = (),
    required: str = "",
    dynamic: Dynamic = None,
    heading: str = "",
) -> Any:
    """Make a field of a settings dataclass that is a parameter.

    A subclass that changes only the default assigns a plain value; the rest is inherited.

    Args:
        default: Default value.
        meaning: One line for people.
        unit: Unit, e.g. ``m/s``.
        bounds: Valid numbers.
        name: Official name, if it differs from the name of the field.
        choices: Valid texts.
        required: See ``Parameter.required``.
        dynamic: See ``Parameter.dynamic``.
        heading: Line above the parameter in generated lists.

    Returns:
        A ``dataclasses.field``.
    """
    description = Parameter(name, default, meaning, unit, bounds, tuple(choices), required, dynamic, heading)
    return dataclasses.field(default=default, metadata={"parameter": description})


def parameters_of(kind: type) -> Tuple[Parameter, ...]:
    """Return the parameters of a settings dataclass in the order of its fields."""
    found = []
    for field in dataclasses.fields(kind):
        if not field.init:
            continue
        description = _description_of(kind, field.name)
        if description is not None:
            found.append(
                dataclasses.replace(
                    description, name=description.name or field.name, default=field.default, field=field.name
                )
            )
    return tuple(found)


def official_names(kind: type) -> Dict[str, str]:
    """Return a map from official parameter name to field of a settings dataclass."""
    return {each.name: each.field for each in parameters_of(kind)}


def check_parameters(settings: Any) -> None:
    """Check that required parameters are set and all values are valid; call it in ``__post_init__``.

    Raises:
        SettingsError: For the first invalid parameter.
    """
    for each in parameters_of(type(settings)):
        value = getattr(settings, each.field)
        if each.required:
            check(value != each.default, each.field, each.required, value)
        elif each.choices:
            check(value in each.choices, each.field, "one of " + ", ".join(each.choices), value)
        elif isinstance(value, (int, float)):
            check(value in each.bounds, each.field, str(each.bounds), value)


def with_unit(unit: str, text: str) -> str:
    """Return a text after its unit: ``[min] brewing time``."""
    return f"[{unit}] {text}" if unit else text


@dataclasses.dataclass(frozen=True)
class DynamicParameter:
    """Parameter that can be changed while a node runs; its type is that of ``default``."""

    name: str
    default: Any
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    choices: Tuple[str, ...] = ()


def dynamic_parameters_of(kind: type) -> Tuple[DynamicParameter, ...]:
    """Return the dynamic parameters of a settings dataclass."""
    return tuple(_tunable(each) for each in parameters_of(kind) if each.dynamic is not None)


def _tunable(description: Parameter) -> DynamicParameter:
    low, high = description.bounds.low, math.inf
    if isinstance(description.dynamic, tuple):
        low, high = description.dynamic
    elif description.dynamic is not None and not isinstance(description.dynamic, bool):
        high = description.dynamic
    return DynamicParameter(
        description.name,
        description.default,
        with_unit(description.unit, description.meaning),
        low,
        high,
        description.choices,
    )


def _description_of(kind: type, field: str):
    """Return the description of a field from the class or the nearest base that has one."""
    for base in kind.__mro__:
        fields = base.__dict__.get("__dataclass_fields__", {})
        if field in fields and "parameter" in fields[field].metadata:
            return fields[field].metadata["parameter"]
    return None


__getattr__ = deprecated_names(__name__, {"Bounds": "Interval"})


T = TypeVar("T")


def settings_from_yaml(kind: Type[T], path: Path) -> Tuple[T, List[str]]:
    """Read a settings dataclass from a YAML file, without a parameter server.

    Args:
        kind: Settings dataclass whose fields are made by ``parameter``.
        path: YAML file.

    Returns:
        The settings, and the names in the file that are no parameters of ``kind``.

    Raises:
        SettingsError: If the file cannot be read or a value is invalid.
    """
    table = read_table(path)
    return settings_from(kind, table.values(), official_names(kind), table.location_of)
