from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict

from evaluation.options import GraphOptions, MissionOptions
from supervision.command_line import option

# All nodes but the simulator are respawned, and resume from a checkpoint or the journal.
RESPAWNED = ("amcl", "move_base", "map_server", "robot_state_publisher", "service", "add_markers")


@dataclass(frozen=True)
class Service(GraphOptions, MissionOptions):
    """Take requests, plan them and carry them out, until Ctrl-C; the next start goes on.

    Requests come from request.sh, over HTTP, over ROS, and from the mission. Everything is in a journal: the
    service may be killed at any moment. docs/how_to/run_a_day_of_service.md.

    Exit code: 0 after Ctrl-C, 1 failure or no result.json, 2 invalid input.
    """

    state: Path = option(
        Path("runs/service"),
        "folder of the journal, and of service.json with address and token",
        type=Path,
        metavar="FOLDER",
    )
    http_port: int = option(0, "port of the HTTP interface (default: a free one)", type=int)

    @property
    def is_interactive(self) -> bool:
        return True

    def run(self) -> int:
        from evaluation.ros.run_modes import run_until_interrupted
        from headless_mission.inputs import read_mission

        places = read_mission(self).places
        launch = self.launch(
            "service.launch",
            **self.files(),
            **self._start(),
            state_folder=self.state.resolve(),
            http_port=self.http_port,
        ).with_respawn(*RESPAWNED)
        launch = replace(launch, tool="service")
        hint = f"send requests with ./scripts/request.sh --state {self.state}; Ctrl-C ends"
        return run_until_interrupted(self, launch, hint, places, idle_text="waiting for requests")

    def _start(self) -> Dict[str, float]:
        """Return where the robot starts: where it was when the service ended."""
        from service.journal import Journal

        path = self.state / "journal.db"
        if not path.exists():
            return {}
        journal = Journal(path)
        robot = journal.restore().robot
        journal.close()
        return {} if robot is None else {"x": robot.pose.x, "y": robot.pose.y, "yaw": robot.pose.yaw}
