"""The parameters of a dynamic_reconfigure server with their bounds (rqt_reconfigure)."""

import ast
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Dict, List, Tuple

# In the order of the fields of a dynamic_reconfigure/Config.
KINDS = {"bools": "bool", "ints": "int", "doubles": "double", "strs": "str"}
# A bound of this size in a .cfg file means no bound.
UNBOUNDED = 1e6


@dataclass(frozen=True)
class ReconfigurableParameter:
    """A parameter of a dynamic_reconfigure server.

    Attributes:
        name: Name of the parameter.
        kind: bool, int, double or str.
        lowest: Lower bound.
        highest: Upper bound.
        default: Default value.
        meaning: Description.
        choices: Name and value of each choice of an enumeration.
    """

    name: str
    kind: str
    lowest: Any
    highest: Any
    default: Any
    meaning: str = ""
    choices: Tuple[Tuple[str, Any], ...] = ()

    @property
    def is_bounded(self) -> bool:
        return self.kind in ("int", "double") and -UNBOUNDED < self.lowest < self.highest < UNBOUNDED

    @property
    def step(self) -> float:
        """Step of the control: about a thousandth of the upper bound."""
        if self.kind == "int":
            return 1
        return 10.0 ** (len(str(int(abs(self.highest)))) - 4) if self.is_bounded else 0.01


def parameters_from_description(description: Any) -> List[ReconfigurableParameter]:
    """Convert a dynamic_reconfigure/ConfigDescription, keeping its order."""
    lowest, highest, default = (
        values_of(part) for part in (description.min, description.max, description.dflt)
    )
    return [
        ReconfigurableParameter(
            parameter.name,
            parameter.type,
            lowest.get(parameter.name),
            highest.get(parameter.name),
            default[parameter.name],
            parameter.description,
            _choices(parameter.edit_method),
        )
        for group in description.groups
        for parameter in group.parameters
        if parameter.name in default
    ]


def values_of(config: Any) -> Dict[str, Any]:
    """Return the values of a dynamic_reconfigure/Config by name."""
    return {each.name: each.value for field in KINDS for each in getattr(config, field)}


def _choices(edit_method: str) -> Tuple[Tuple[str, Any], ...]:
    """Parse an enumeration, which the generator writes as a Python literal."""
    with suppress(ValueError, SyntaxError, KeyError, TypeError, AttributeError, MemoryError, RecursionError):
        listed = ast.literal_eval(edit_method)["enum"]
        return tuple((str(choice["name"]), choice["value"]) for choice in listed)
    return ()
