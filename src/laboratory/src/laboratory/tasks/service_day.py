"""A day of service: generated requests, charging in a dock."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
import yaml

from evaluation.verdict import collision
from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from laboratory.tasks.task import COLLISION, FAILURE, SUCCESS, RunConditions, RunTrace
from laboratory.worlds.source import Arena
from pick_objects import load_mission
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.files.writing import write_atomically
from planar.maps.places import NamedPlace, parse_pose, places_table
from service.day.day_report import day_report
from service.day.preparation import MIDNIGHT, DayPlan, generated_requests, prepare_day, start_pose
from service.day.requests_by_hour import DaySettings
from service.day.simulated_day import SimulatedDayRecord
from service.requests.timed_requests import TimedRequest, save_requests
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
        reports: Folder of the reports of days; None: none are written.
    """

    requests: int
    mission: Path
    dock: Pose2
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
        )
        day = prepare_day(
            plan, self._requests(seed), conditions.navigation(NAVIGATION_CONFIG), conditions, seed
        )
        record = day.run(MIDNIGHT + scenario.seconds)
        if self.reports is not None:
            self.reports.mkdir(parents=True, exist_ok=True)
            self.write_report(self.reports / f"seed_{seed}.html", record, arena, seed)
        return trace_of(record)

    def write_report(self, path: Path, record: SimulatedDayRecord, arena: Arena, seed: int) -> None:
        """Write the page of a day.

        Args:
            path: File.
            record: What came of the day.
            arena: World and map.
            seed: Seed of the day.
        """
        assert arena.grid is not None
        page = day_report(record, arena.grid, MIDNIGHT, f"Day of service, {arena.title}, seed {seed}")
        write_atomically(path, page.encode())

    @property
    def start(self) -> Pose2:
        """Start pose of the robot in the world: in its dock."""
        return start_pose(self.dock)

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        return [
            *(pose for place in self._places().values() for pose in place.poses),
            self.dock @ Pose2(STAGING),
        ]

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        return None

    def files(self) -> Tuple[Path, ...]:
        return (self.mission,)

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Any]:
        zones_file, dock = folder / "places.yaml", self.dock
        places = self._places()
        zones_file.write_text(yaml.safe_dump(places_table(places.values())), encoding="utf-8")
        return {
            "zones_file": zones_file,
            "requests_file": save_requests(folder / "requests.json", self._requests(seed)),
            "origin": MIDNIGHT,
            "state_folder": folder / "state",
            "dock": f"{dock.x} {dock.y} {dock.yaw}",
        }

    def _requests(self, seed: int) -> List[TimedRequest]:
        return generated_requests(list(self._places()), DaySettings(requests=self.requests), seed)

    def _places(self) -> Dict[str, NamedPlace]:
        return dict(load_mission(self.mission, {}).places)


def trace_of(record: SimulatedDayRecord) -> RunTrace:
    """Return the trace of a day; its score is the share of deadlines that were kept."""
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
    """Read ``service_day``: the number of requests; ``mission``, ``dock`` and ``reports``."""
    table.allow_only("service_day", "mission", "dock", "reports")
    dock = table.table("dock")
    dock.allow_only("x", "y", "yaw")
    return ServiceDayTask(
        table.count("service_day"),
        table.path("mission", folder),
        parse_pose(dock),
        folder / table.text("reports") if "reports" in table else None,
    )
