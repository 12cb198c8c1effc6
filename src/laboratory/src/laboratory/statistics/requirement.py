"""Requirements on the figures of a scenario, such as ``success >= 0.99``."""

import operator
import re
from typing import Mapping, NamedTuple

from laboratory.statistics.summary import FIGURES, ConfidenceInterval
from planar import SettingsError
from planar.config.hints import hint_or_choices

RELATIONS = {">=": operator.ge, "<=": operator.le, ">": operator.gt, "<": operator.lt}
FORM = re.compile(r"\s*(\w+)\s*(>=|<=|>|<)\s*([0-9.eE+-]+)\s*")


class Requirement(NamedTuple):
    """A figure, a relation and a limit."""

    figure: str
    relation: str
    limit: float

    def is_met(self, figures: Mapping[str, ConfidenceInterval]) -> bool:
        """Return whether the figure satisfies the requirement; a missing figure does not."""
        found = figures.get(self.figure)
        return found is not None and bool(RELATIONS[self.relation](found.value, self.limit))

    def __str__(self) -> str:
        return f"{self.figure} {self.relation} {self.limit:g}"


def parse_requirement(text: str) -> Requirement:
    """Parse a requirement. Raises SettingsError."""
    match = FORM.fullmatch(text)
    try:
        figure, relation, limit = match.groups() if match else ("", "", "")
        requirement = Requirement(figure, relation, float(limit))
    except ValueError:
        raise SettingsError(f'--require must be like "success >= 0.99", got {text!r}') from None
    if requirement.figure not in FIGURES:
        raise SettingsError(
            f'--require: unknown figure "{requirement.figure}"{hint_or_choices(requirement.figure, FIGURES)}'
        )
    return requirement
