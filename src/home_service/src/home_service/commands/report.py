from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import argument, option


@dataclass(frozen=True)
class Report:
    """Make the report of a run again from its folder: report.html, run.png, the trajectories.

    Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
    """

    folder: Path = argument("run folder", type=Path, metavar="RUN")
    gif: bool = option(False, "also make run.gif, the run as an animation")

    def run(self) -> int:
        from run_report import summary, write_report
        from run_report.comparison import load_run
        from supervision.run_folder import write_result

        run = load_run(self.folder)
        result = {**run.result, **summary(run.record), "missing": []}
        missing = write_report(run.folder, result, run.record, self.gif)
        write_result(run.folder, {**result, "missing": missing})
        for gap in missing:
            print(f"warning: missing: {gap}")
        print(f"report in {run.folder / 'report.html'}")
        return 1 if missing else 0
