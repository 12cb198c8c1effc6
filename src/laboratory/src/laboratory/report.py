"""What came of suites, in the terminal, and whether that will do."""

from typing import Dict, List, Sequence

from laboratory.evaluation import EvaluatedScenario
from laboratory.page.page import comparison_text
from laboratory.statistics.comparison import WORSE, compare
from laboratory.statistics.requirement import Requirement


def summary_lines(evaluated: Sequence[EvaluatedScenario]) -> List[str]:
    """The figures of each scenario, and how its planners compare with the first of them."""
    lines: List[str] = []
    first: Dict[str, EvaluatedScenario] = {}
    for each in evaluated:
        text = each.summary
        outcomes = ", ".join(f"{number} {name}" for name, number in text.outcomes.items() if number)
        lines.append(f"{each.scenario.label}: {text.runs} runs: {outcomes or 'none played'}")
        for name, estimate in text.figures.items():
            if text.runs and (name not in text.outcomes or name == "success"):
                lines.append(f"  {name:<12} {estimate}")
        rival = first.setdefault(each.scenario.name, each)
        if rival is not each:
            lines.append(
                f"  beside {rival.scenario.label}: {comparison_text(compare(rival.results, each.results))}"
            )
    return lines


def regressions(evaluated: Sequence[EvaluatedScenario], earlier: Sequence[EvaluatedScenario]) -> List[str]:
    """A line for each scenario that has become worse, in success or in time, on the same seeds."""
    lines = []
    for now, before in zip(evaluated, earlier):
        comparison = compare(before.results, now.results)
        if WORSE in (comparison.success, comparison.time):
            lines.append(f"{now.scenario.label}: worse than before: {comparison_text(comparison)}")
    return lines


def violated_requirements(evaluated: Sequence[EvaluatedScenario], rules: Sequence[Requirement]) -> List[str]:
    """A line for each rule that does not hold of a scenario."""
    return [
        f"{each.scenario.label}: not {rule}"
        for each in evaluated
        for rule in rules
        if not rule.is_met(each.summary.figures)
    ]
