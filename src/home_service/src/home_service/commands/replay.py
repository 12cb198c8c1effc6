import os
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Mapping, Optional, Sequence, Tuple

from evaluation.options import ROOT, LaunchPlan, RunOptions
from supervision.command_line import argument, option, seed


@dataclass(frozen=True)
class Replay(RunOptions):
    """Play recorded bags to localization or mapping, and measure the result.

    Bags of recorded runs, or any with scans, odometry and /tf, are replayed without the recorded estimate.
    The result is measured against ground truth, if that was recorded. Bags are only read; a truncated one
    is replayed to its end, which the result states. Creates a run folder with report, trajectories (TUM)
    and result.json.

    Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
    """

    bags: Tuple[Path, ...] = argument(
        "bags, folders of bags or run folders", default=(), type=Path, nargs="+", metavar="BAG"
    )
    estimator: str = option(
        "amcl",
        "localize in the map, make a map, or only show what was recorded",
        flag="--with",
        choices=("amcl", "slam", "recorded"),
    )
    map: Path = option(ROOT / "map/home.yaml", "for amcl: the map", type=Path)
    start: Tuple[float, float, float] = option(
        (0.0, 0.0, 0.0),
        "for amcl: where the robot starts in the map",
        type=float,
        nargs=3,
        metavar=("X", "Y", "YAW"),
    )
    seed: int = option(0, "seed of all particles", type=seed)
    save: Optional[Path] = option(
        None, "for slam: write STEM.pgm and STEM.yaml, not to the run folder", type=Path, metavar="STEM"
    )

    def run(self) -> int:
        from home_service.ros.replaying import inputs_of, open_recording, replay

        recording = open_recording(self.bags, needs_scans=self.estimator != "recorded")
        inputs: Dict[str, str] = {}
        if self.estimator != "recorded":
            inputs = inputs_of(recording, needs_odometry=self.estimator == "amcl")
        launch = self._launch(recording.paths, inputs)
        return replay(self, launch, recording, saves_map=self.estimator == "slam", stem=self.save)

    def _launch(self, bags: Sequence[Path], inputs: Mapping[str, str]) -> LaunchPlan:
        from evaluation.recording_plan import recording_plan
        from planar import load_map

        if self.estimator == "recorded":
            return recording_plan(bags)
        if self.estimator == "amcl":
            load_map(self.map)  # so that a mistake is reported before anything is started
        x, y, yaw = self.start
        arguments = {
            **inputs,
            "bags": os.pathsep.join(str(path.resolve()) for path in bags),
            "estimator": self.estimator,
            "map_file": self.map.resolve(),
            "x": x,
            "y": y,
            "yaw": yaw,
            "seed": self.seed,
        }
        return LaunchPlan("replay.launch", arguments, is_simulated=False)
