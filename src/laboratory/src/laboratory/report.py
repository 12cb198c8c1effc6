"""Text report of an evaluation, and its checks against requirements and earlier versions."""

from typing import Dict, List, Sequence

from laboratory.evaluation import EvaluatedScenario
from laboratory.page.page import comparison_text
from laboratory.statistics.comparison import WORSE, compare
from laboratory.statistics.requirement import Requirement


def summary_lines(evaluated: Sequence[EvaluatedScenario]) -> List[str]:
    """Return the figures of each scenario, and the comparison of its planners with the first of them."""
    lines: List[str] = []
    first: Dict[str, EvaluatedScenario] = {}
    for each in evaluated:
        summary = each.summary
        outcomes = ", ".join(f"{number} {name}" for name, number in summary.outcomes.items() if number)
        lines.append(f"{each.scenario.label}: {summary.runs} runs: {outcomes or 'none completed'}")
        for name, estimate in summary.figures.items():
            if summary.runs and (name not in summary.outcomes or name == "success"):
                lines.append(f"  {name:<12} {estimate}")
        baseline = first.setdefault(each.scenario.name, each)
        if baseline is not each:
            comparison = comparison_text(compare(baseline.results, each.results))
            lines.append(f"  compared with {baseline.scenario.label}: {comparison}")
    return lines


def regressions(evaluated: Sequence[EvaluatedScenario], earlier: Sequence[EvaluatedScenario]) -> List[str]:
    """Return a line for each scenario that is significantly worse in success or time on the same seeds."""
    lines = []
    for now, before in zip(evaluated, earlier):
        comparison = compare(before.results, now.results)
        if WORSE in (comparison.success, comparison.time):
            lines.append(f"{now.scenario.label}: worse than before: {comparison_text(comparison)}")
    return lines


def violated_requirements(evaluated: Sequence[EvaluatedScenario], rules: Sequence[Requirement]) -> List[str]:
    """Return a line for each requirement that a scenario does not satisfy."""
    return [
        f"{each.scenario.label}: requirement not met: {rule}"
        for each in evaluated
        for rule in rules
        if not rule.is_met(each.summary.figures)
    ]
