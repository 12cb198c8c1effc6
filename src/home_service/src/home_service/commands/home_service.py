from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from evaluation.options import GraphOptions, MissionOptions
from evaluation.verdict import ERRAND, MARKERS, OBJECTS
from supervision.command_line import option

# All nodes but the simulator are respawned, and resume from a checkpoint.
RESPAWNED = ("amcl", "move_base", "map_server", "robot_state_publisher", "pick_objects", "add_markers")


@dataclass(frozen=True)
class HomeService(GraphOptions, MissionOptions):
    """Fetch the object at the pick-up zone and deliver it at the drop-off zone.

    Or runs another mission. Prints the run folder with logs and result.json, and a verdict.

    Exit code: 0 success, and Ctrl-C with --serve; 1 failure or no result.json, 2 invalid input, 130
    interrupted.
    """

    faults: Optional[Path] = option(
        None,
        "YAML with a list of faults (docs/reference/faults.md; default: that of the mission)",
        type=Path,
    )
    serve: bool = option(False, "wait for missions sent to the action deliver, until Ctrl-C")
    marker_source: str = option(
        "tf", "source of the robot pose for the marker", choices=("tf", "amcl_pose", "odom", "state")
    )

    @property
    def is_interactive(self) -> bool:
        return self.serve

    def run(self) -> int:
        from evaluation.ros.run_modes import run_to_completion, run_until_interrupted
        from headless_mission.inputs import read_mission

        places = read_mission(self).places
        launch = self.launch(
            "home_service.launch",
            **self.files(),
            marker_source=self.marker_source,
            marker_mode="mission" if self.mission or self.serve else "service",
            serve=str(self.serve).lower(),
            faults_file=self._faults_file(),
        ).with_respawn(*RESPAWNED)
        if self.serve:
            return run_until_interrupted(
                self,
                launch,
                "send missions to the action deliver; Ctrl-C ends",
                places,
                idle_text="waiting for a mission",
            )
        return run_to_completion(self, launch, places, {ERRAND, OBJECTS if self.mission else MARKERS})

    def _faults_file(self) -> str:
        """Return the file with faults; empty if there are none."""
        faulty = self.faults or self.mission
        if faulty is None:
            return ""
        from sim_bridge.faults import load_faults  # late: imports much of the simulator

        return str(faulty.resolve()) if load_faults(faulty) else ""
