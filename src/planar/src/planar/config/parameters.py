"""Parameters: fields of settings that know their official name, unit, bounds and meaning.

They are said once, in the dataclass; lists of them are made from it (planar.config.config_file)::

    @dataclass(frozen=True)
    class TeaSettings:
        minutes: float = parameter(3.0, "how long it draws", "min", POSITIVE)
        kind: str = parameter("green", "what is brewed", choices=("green", "black"), name="tea_type")

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
    """From ``low`` (itself included unless ``without_low``) to ``high``; ``words`` say so in errors."""

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
    return Interval(low, words=f"at least {low:g}")


@dataclasses.dataclass(frozen=True)
class Parameter:
    """What there is to know of a parameter.

    ``required``: what it must be ("the path of a file") if it has no default, which then counts as not set.
    ``dynamic``: whether dynamic_reconfigure may change it while the node runs (True); for a number, the
    largest value that it then offers, for two, the least and the largest. ``heading``: stands above it where
    parameters are listed.
    ``field``: that of the settings, if it is one of theirs.
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
        """The meaning, and behind it the choices unless it names them all."""
        if all(choice in self.meaning for choice in self.choices):
            return self.meaning
        return f"{self.meaning}: {', '.join(self.choices)}"

    def with_default(self, default: Any) -> "Parameter":
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
    """A field of a settings dataclass that is a parameter; ``name``: the official one, if another.

    A subclass that has another default gives just that; the rest is as its base says.
    """
    said = Parameter(name, default, meaning, unit, bounds, tuple(choices), required, dynamic, heading)
    return dataclasses.field(default=default, metadata={"parameter": said})


def parameters_of(kind: type) -> Tuple[Parameter, ...]:
    """The parameters among the fields of a settings dataclass that can be given, in their order."""
    found = []
    for field in dataclasses.fields(kind):
        if not field.init:
            continue
        said = _said_of(kind, field.name)
        if said is not None:
            found.append(
                dataclasses.replace(
                    said, name=said.name or field.name, default=field.default, field=field.name
                )
            )
    return tuple(found)


def official_names(kind: type) -> Dict[str, str]:
    """The table official parameter name -> field of a settings dataclass."""
    return {each.name: each.field for each in parameters_of(kind)}


def check_parameters(settings: Any) -> None:
    """Raises SettingsError for the first parameter that is not set though required, or out of its bounds."""
    for each in parameters_of(type(settings)):
        value = getattr(settings, each.field)
        if each.required:
            check(value != each.default, each.field, each.required, value)
        elif each.choices:
            check(value in each.choices, each.field, "one of " + ", ".join(each.choices), value)
        elif isinstance(value, (int, float)):
            check(value in each.bounds, each.field, str(each.bounds), value)


def with_unit(unit: str, text: str) -> str:
    """The text behind its unit: "[min] how long it draws"."""
    return f"[{unit}] {text}" if unit else text


@dataclasses.dataclass(frozen=True)
class DynamicParameter:
    """A value that may be changed while a node runs; its type is that of the ``default``."""

    name: str
    default: Any
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    choices: Tuple[str, ...] = ()


def dynamic_parameters_of(kind: type) -> Tuple[DynamicParameter, ...]:
    """The parameters of a settings dataclass that are dynamic."""
    return tuple(_tunable(each) for each in parameters_of(kind) if each.dynamic is not None)


def _tunable(said: Parameter) -> DynamicParameter:
    low, high = said.bounds.low, math.inf
    if isinstance(said.dynamic, tuple):
        low, high = said.dynamic
    elif said.dynamic is not None and not isinstance(said.dynamic, bool):
        high = said.dynamic
    return DynamicParameter(
        said.name, said.default, with_unit(said.unit, said.meaning), low, high, said.choices
    )


def _said_of(kind: type, field: str):
    """What the class, or else the nearest of its bases, says of a field."""
    for base in kind.__mro__:
        fields = base.__dict__.get("__dataclass_fields__", {})
        if field in fields and "parameter" in fields[field].metadata:
            return fields[field].metadata["parameter"]
    return None


__getattr__ = deprecated_names(__name__, {"Bounds": "Interval"})


T = TypeVar("T")


def settings_from_yaml(kind: Type[T], path: Path) -> Tuple[T, List[str]]:
    """The dataclass ``kind`` (fields made by ``parameter``) filled from a file; the names unknown to it.

    Raises SettingsError.
    """
    table = read_table(path)
    return settings_from(kind, table.values(), official_names(kind), table.location_of)
