"""A day of service: generated requests, charging in a dock, furniture that is moved."""

from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from evaluation.verdict import collision
from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from laboratory.tasks.task import COLLISION, FAILURE, SUCCESS, RunConditions, RunTrace
from laboratory.worlds.source import Arena
from pick_objects import load_mission
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.files.writing import write_atomically
from planar.maps.places import NamedPlace, parse_pose
from service.day.day_report import day_report
from service.day.preparation import MIDNIGHT, DayPlan, prepare_day
from service.day.requests_by_hour import DaySettings
from service.day.simulated_day import SimulatedDayRecord
from sim_bridge import robot_named

HOUR = 3600.0
# Distance before the dock within which no box stands, with that of boxes from all places [m].
STAGING = 0.8


@dataclass(frozen=True)
class ServiceDayTask:
    """A day of service in a given home, from midnight until the scenario's limit.

    Attributes:
        requests: Number of requests.
        mission: Mission file with the places.
        dock: Pose of the dock in the world.
        moves: How often one of the boxes of the scenario is moved.
        reports: Folder of the reports of days; None: none are written.
    """

    requests: int
    mission: Path
    dock: Pose2
    moves: int = 0
    reports: Optional[Path] = None

    def run(self, scenario: RunConditions, arena: Arena, seed: int) -> RunTrace:
        conditions = EpisodeConditions(
            scenario.planner, scenario.parameters, scenario.faults, scenario.simulation
        )
        if arena.grid is None:
            raise SettingsError(f"{arena.title}: the task service_day needs a world with a map")
        plan = DayPlan(
            arena.world,
            robot_named(scenario.robot),
            arena.grid,
            self._places(),
            self.dock,
            DaySettings(requests=self.requests),
            _boxes(arena),
            self.moves,
        )
        day = prepare_day(plan, conditions.navigation(NAVIGATION_CONFIG), conditions, seed)
        record = day.run(MIDNIGHT + scenario.seconds)
        if self.reports is not None:
            title = f"Day of service, {arena.title}, seed {seed}"
            page = day_report(record, arena.grid, MIDNIGHT, title)
            self.reports.mkdir(parents=True, exist_ok=True)
            write_atomically(self.reports / f"seed_{seed}.html", page.encode())
        return _trace(record)

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        return [
            *(pose for place in self._places().values() for pose in place.poses),
            self.dock @ Pose2(STAGING),
        ]

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        return None

    def files(self) -> Tuple[Path, ...]:
        return (self.mission,)

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Path]:
        raise SettingsError("service_day runs in one process only; over ROS use ./scripts/service.sh")

    def _places(self) -> Dict[str, NamedPlace]:
        return dict(load_mission(self.mission, {}).places)


def _boxes(arena: Arena) -> Dict[str, Pose2]:
    """Return the poses of the boxes that are not in the map."""
    boxes = (body for body in arena.world.bodies if body.model.startswith("box_"))
    return {body.model: Pose2(*body.pose_in_world[:2, 3].tolist()) for body in boxes}


def _trace(record: SimulatedDayRecord) -> RunTrace:
    track = np.array(record.track)[:, :4] - (MIDNIGHT, 0.0, 0.0, 0.0)
    outcome, reason = _outcome(record)
    share = len(record.kept) / len(record.with_deadline) if record.with_deadline else None
    return RunTrace(outcome, reason, track, np.zeros(0), record.contacts, score=share)


def _outcome(record: SimulatedDayRecord) -> Tuple[str, str]:
    kept = f"{len(record.kept)} of {len(record.with_deadline)} deadlines kept"
    problems: List[str] = []
    cause = collision(record.contacts)
    if record.empty_at is not None:
        problems.append(f"the battery was empty after {(record.empty_at - MIDNIGHT) / HOUR:.1f} h")
    failed = [task for task in record.ended if task.status.value == "failed"]
    problems += [f"{task.id} failed: {task.reason}" for task in failed[:3]]
    text = "; ".join([*([cause] if cause else []), *problems, kept])
    return (COLLISION if cause else FAILURE if problems else SUCCESS), text


def read_service_day(table: Table, folder: Path) -> ServiceDayTask:
    """Read ``service_day``: the number of requests; ``mission``, ``dock``, and what else there is."""
    table.allow_only("service_day", "mission", "dock", "moves", "reports")
    dock = table.table("dock")
    dock.allow_only("x", "y", "yaw")
    return ServiceDayTask(
        table.count("service_day"),
        table.path("mission", folder),
        parse_pose(dock),
        table.count("moves") if "moves" in table else 0,
        folder / table.text("reports") if "reports" in table else None,
    )
