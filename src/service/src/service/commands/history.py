from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import option


@dataclass(frozen=True)
class History:
    """Show the requests that a service has carried out, with figures, from its journal.

    Exit code: 0 success, 2 there is no journal, or it is damaged.
    """

    state: Path = option(Path("runs/service"), "folder of the service", type=Path, metavar="FOLDER")
    last: int = option(20, "number of requests to list", type=int)
    since: str = option("", "only those that ended after a time: 08:00 or 2026-11-30T08:00", metavar="TIME")

    def run(self) -> int:
        import time

        from service.history import figure_lines, figures_of, history_lines
        from service.journal import Journal
        from service.requests.calendar_times import DAY, parse_time

        now = time.time()
        since = parse_time(self.since, now) if self.since else 0.0
        since -= DAY if since > now else 0.0  # a time of day that is still to come was meant yesterday
        journal = Journal(self.state / "journal.db", is_reader=True)
        tasks = journal.ended_tasks(since, limit=100_000)
        for line in reversed(history_lines(tasks[: max(0, self.last)])):
            print(line)
        for line in figure_lines(figures_of(tasks)):
            print(line)
        return 0
