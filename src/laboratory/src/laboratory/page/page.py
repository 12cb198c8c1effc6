"""The HTML page: leaderboard, failures with heat maps, and notable runs of each scenario."""

import shlex
from html import escape
from typing import Any, Dict, List, Sequence, Tuple

from laboratory.page.maps import heat_map, run_map
from laboratory.results.result import RunResult
from laboratory.scenario.scenario import Scenario
from laboratory.statistics.comparison import Comparison, compare
from laboratory.suites import FOLDER
from run_report.page import document, table, tiles

# Maximum number of failed runs and of heat maps that are drawn for a scenario.
MAX_RUN_MAPS, MAX_HEAT_MAPS = 24, 6
HEADS = (
    "planner",
    "runs",
    "success",
    "collisions",
    "time, s",
    "SPL",
    "clearance, m",
    "compared with the first",
)
FIGURES = ("seconds", "spl", "clearance")


def page_html(evaluated: Sequence[Any], version: str) -> str:
    """Return the HTML page of evaluated scenarios (laboratory.evaluation.EvaluatedScenario)."""
    by_name: Dict[str, List[Any]] = {}
    for each in evaluated:
        by_name.setdefault(each.scenario.name, []).append(each)
    runs = sum(len(each.results) for each in evaluated)
    won = sum(result.is_success for each in evaluated for result in each.results)
    body = [
        "<header><h1>Evaluation</h1><p>All intervals have 95 % confidence.</p></header>",
        tiles([("scenarios", str(len(by_name))), ("runs", str(runs)), ("succeeded", str(won))]),
        tiles([("version", version)]),
    ]
    for name, planners in by_name.items():
        body.append(_leaderboard(name, planners))
        body += [_failures(each) for each in planners]
        body += [_notable_runs(each) for each in planners]
    return document("Evaluation", "".join(body))


def comparison_text(comparison: Comparison) -> str:
    """Describe a comparison in one line."""
    if not comparison.pairs:
        return "no seeds in common"
    counts = f"+{comparison.gained} −{comparison.lost}, p {comparison.p_success:.2g}"
    text = f"success: {comparison.success} ({counts})"
    if comparison.seconds is None:
        return text
    delay, p_seconds = comparison.seconds, comparison.p_seconds
    return f"{text}; time: {comparison.time} ({delay.value:+.2f} s, p {p_seconds:.2g})"


def repeat_command(scenario: Scenario, seed: int) -> str:
    """Return the command that repeats a run."""
    is_given = scenario.file.parent == FOLDER
    words = ["./scripts/play.sh", scenario.name if is_given else str(scenario.file), "--seed", str(seed)]
    words += ["--planner", scenario.planner] if scenario.planner else []
    words += ["--localizer", scenario.localizer] if scenario.localizer else []
    return shlex.join(words + (["--over", "ros"] if scenario.is_over_ros else []))


def _leaderboard(name: str, planners: Sequence[Any]) -> str:
    """Planners sorted by the lower bound of their success rate."""
    summaries = [(each, each.summary) for each in planners]
    ranked = sorted(summaries, key=lambda row: -row[1].figures["success"].low)
    first = planners[0]
    rows = []
    for each, summary in ranked:
        figures = [str(summary.figures.get(figure, "")) for figure in FIGURES]
        comparison = "" if each is first else comparison_text(compare(first.results, each.results))
        planner = each.scenario.planner or "default of the robot"
        success, collisions = summary.figures["success"], summary.outcomes["collision"]
        rows.append((planner, summary.runs, success, collisions, *figures, comparison))
    about = f"<p>{escape(planners[0].scenario.about)}</p>"
    filled = [(head, cells) for head, *cells in zip(HEADS, *rows) if any(map(str, cells))]
    board = table([head for head, _ in filled], list(zip(*(cells for _, cells in filled))))
    return f'<section class="card"><h2>{escape(name)}</h2>{about}{board}</section>'


def _failures(each: Any) -> str:
    """A heat map for each world, and each failed run with its map and the command that repeats it."""
    failed = [result for result in each.results if not result.is_success]
    if not failed:
        return ""
    drawn = [result for result in failed if result.track]
    worlds: Dict[int, List[RunResult]] = {}
    for result in drawn:
        worlds.setdefault(result.arena_number, []).append(result)
    fullest = sorted(worlds.values(), key=lambda runs: -len(runs))[:MAX_HEAT_MAPS]
    maps = [
        _card(f"{runs[0].arena}: where {len(runs)} failed", heat_map(each.scenario, runs)) for runs in fullest
    ]
    cards = [_run(each.scenario, result) for result in drawn[:MAX_RUN_MAPS]]
    rows = [(run.seed, run.outcome, run.reason, repeat_command(each.scenario, run.seed)) for run in failed]
    listed = table(("seed", "outcome", "reason", "command"), rows)
    title = f"<h2>{escape(each.scenario.label)}: {len(failed)} of {len(each.results)} failed</h2>"
    return f'<section class="card">{title}{listed}</section>' + _card_grid(maps) + _card_grid(cards)


def _notable_runs(each: Any) -> str:
    """The slowest successful run, and the one with the smallest clearance."""
    won = [result for result in each.results if result.is_success]
    chosen: List[Tuple[str, RunResult]] = []
    if won:
        chosen.append(("slowest success", max(won, key=lambda run: run.seconds or 0.0)))
    near = [result for result in won if result.clearance is not None]
    if near:
        chosen.append(("smallest clearance", min(near, key=lambda run: run.clearance or 0.0)))
    return _card_grid([_run(each.scenario, run, f"{title}: ") for title, run in chosen])


def _run(scenario: Scenario, result: RunResult, title: str = "") -> str:
    text = f"{title}{scenario.label}, seed {result.seed}: {result.outcome}"
    figures = "" if result.seconds is None else f" after {result.seconds:.1f} s, {result.driven:.1f} m"
    drawn = run_map(scenario, result) if result.track else ""
    command = f"<p><code>{escape(repeat_command(scenario, result.seed))}</code></p>"
    return _card(f"{text}{figures}", f"<p>{escape(result.reason)}</p>{drawn}{command}")


def _card(title: str, content: str) -> str:
    return f'<div class="card"><h2>{escape(title)}</h2>{content}</div>'


def _card_grid(cards: Sequence[str]) -> str:
    """Two cards in each row."""
    pairs = [cards[number : number + 2] for number in range(0, len(cards), 2)]
    return "".join(f'<section class="even columns">{"".join(pair)}</section>' for pair in pairs)
