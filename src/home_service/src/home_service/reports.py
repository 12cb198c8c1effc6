"""The commands that look at runs that are over."""

from argparse import Namespace

from rich.console import Console
from rich.table import Table

from planar import write_atomically
from run_report import summary, write_report
from run_report.comparison import compared_figures, comparison_html, load_run
from supervision.run_folder import write_result


def report(options: Namespace) -> int:
    """Makes the report of a run anew from what was recorded of it."""
    run = load_run(options.run)
    result = {**run.result, **summary(run.record), "missing": []}
    missing = write_report(run.folder, result, run.record, options.gif)
    write_result(run.folder, {**result, "missing": missing})
    for gap in missing:
        print(f"warning: missing: {gap}")
    print(f"report in {run.folder / 'report.html'}")
    return 1 if missing else 0


def compare(options: Namespace) -> int:
    """Prints two runs as a table and writes them as a page."""
    runs = load_run(options.first), load_run(options.second)
    table = Table("", "A", "B", caption=f"A: {runs[0].folder.name}\nB: {runs[1].folder.name}")
    for row in compared_figures(*runs):
        table.add_row(*row, style="bold" if row.name == "outcome" else None)
    Console().print(table)
    path = options.page or runs[1].folder / "compare.html"
    write_atomically(path, comparison_html(*runs).encode("utf-8"))
    print(f"both runs in {path}")
    return 0
