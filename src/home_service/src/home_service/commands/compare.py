from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import argument, option


@dataclass(frozen=True)
class Compare:
    """Compare two run folders: a table in the terminal, and a page with both maps and charts.

    Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
    """

    first: Path = argument("folder of a run", type=Path, metavar="A")
    second: Path = argument("folder of another run", type=Path, metavar="B")
    page: Optional[Path] = option(
        None, "file of the page (default: compare.html in B)", type=Path, metavar="FILE"
    )

    def run(self) -> int:
        from rich.console import Console
        from rich.table import Table

        from planar import write_atomically
        from run_report.comparison import compared_figures, comparison_html, load_run

        runs = load_run(self.first), load_run(self.second)
        table = Table("", "A", "B", caption=f"A: {runs[0].folder.name}\nB: {runs[1].folder.name}")
        for row in compared_figures(*runs):
            table.add_row(*row, style="bold" if row.name == "outcome" else None)
        Console().print(table)
        path = self.page or runs[1].folder / "compare.html"
        write_atomically(path, comparison_html(*runs).encode("utf-8"))
        print(f"both runs in {path}")
        return 0
