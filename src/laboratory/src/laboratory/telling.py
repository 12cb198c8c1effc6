"""What came of suites, in the terminal, and whether that will do."""

from typing import Dict, List, Sequence

from laboratory.evaluation import Evaluated
from laboratory.page.page import verdict
from laboratory.statistics.comparison import WORSE, compare
from laboratory.statistics.requirement import Requirement


def lines_of(evaluated: Sequence[Evaluated]) -> List[str]:
    """The figures of each scenario, and how its planners compare with the first of them."""
    lines: List[str] = []
    first: Dict[str, Evaluated] = {}
    for each in evaluated:
        told = each.summary
        outcomes = ", ".join(f"{number} {name}" for name, number in told.outcomes.items() if number)
        lines.append(f"{each.scenario.label}: {told.runs} runs: {outcomes or 'none played'}")
        for name, estimate in told.figures.items():
            if told.runs and (name not in told.outcomes or name == "success"):
                lines.append(f"  {name:<12} {estimate}")
        rival = first.setdefault(each.scenario.name, each)
        if rival is not each:
            lines.append(f"  beside {rival.scenario.label}: {verdict(compare(rival.results, each.results))}")
    return lines


def regressions(evaluated: Sequence[Evaluated], earlier: Sequence[Evaluated]) -> List[str]:
    """A line for each scenario that has become worse, in success or in time, on the same seeds."""
    lines = []
    for now, before in zip(evaluated, earlier):
        comparison = compare(before.results, now.results)
        if WORSE in (comparison.success, comparison.time):
            lines.append(f"{now.scenario.label}: worse than before: {verdict(comparison)}")
    return lines


def broken_rules(evaluated: Sequence[Evaluated], rules: Sequence[Requirement]) -> List[str]:
    """A line for each rule that does not hold of a scenario."""
    return [
        f"{each.scenario.label}: not {rule}"
        for each in evaluated
        for rule in rules
        if not rule.is_met(each.summary.figures)
    ]
