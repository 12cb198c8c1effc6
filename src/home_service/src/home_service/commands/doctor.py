import json
from dataclasses import dataclass
from typing import Optional

from supervision.command_line import option, seconds

HEALTHY, UNHEALTHY, NOTHING_RUNS = 0, 1, 3


@dataclass(frozen=True)
class Doctor:
    """Report what is running, what each node waits for, and what is wrong.

    Prints the chain of frames, rates, clock and versions as well. Inspects the graph of ROS_MASTER_URI or,
    without a master there, the newest one on this machine.

    Exit code: 0 healthy, 1 problems, 2 invalid input, 3 nothing is running.
    """

    json: bool = option(False, "print JSON")
    master: Optional[str] = option(None, "master of the graph, if there are several", metavar="URI")
    seconds: float = option(2.0, "duration of the measurement of rates", type=seconds)

    def run(self) -> int:
        from home_service.doctor.diagnosis import as_json, as_text, problems
        from home_service.ros.graph_inspection import inspect_graph

        snapshot = inspect_graph(self.master, self.seconds)
        if self.json:
            print(json.dumps(as_json(snapshot), indent=2))
        else:
            print("\n".join(as_text(snapshot)))
        if snapshot.master is None:
            return NOTHING_RUNS
        return UNHEALTHY if problems(snapshot) else HEALTHY
