"""What a dynamic_reconfigure server lets be changed, with its bounds (rqt_reconfigure)."""

import ast
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Dict, List, Tuple

# In the order of the fields of a dynamic_reconfigure/Config.
KINDS = {"bools": "bool", "ints": "int", "doubles": "double", "strs": "str"}
# What makers of .cfg files write for "no bound".
UNBOUNDED = 1e6


@dataclass(frozen=True)
class Knob:
    """A parameter: ``kind`` is bool, int, double or str; ``choices``: the name and value of each, if few."""

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
        """How fine its control goes: a thousandth of what is as large as its bounds."""
        if self.kind == "int":
            return 1
        return 10.0 ** (len(str(int(abs(self.highest)))) - 4) if self.is_bounded else 0.01


def knobs_of(description: Any) -> List[Knob]:
    """Of a dynamic_reconfigure/ConfigDescription, in its order."""
    lowest, highest, default = (
        values_of(part) for part in (description.min, description.max, description.dflt)
    )
    return [
        Knob(
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
    """The values of a dynamic_reconfigure/Config by name."""
    return {each.name: each.value for field in KINDS for each in getattr(config, field)}


def _choices(edit_method: str) -> Tuple[Tuple[str, Any], ...]:
    """The generator writes an enumeration as a Python literal."""
    with suppress(ValueError, SyntaxError, KeyError, TypeError, AttributeError, MemoryError, RecursionError):
        listed = ast.literal_eval(edit_method)["enum"]
        return tuple((str(choice["name"]), choice["value"]) for choice in listed)
    return ()
