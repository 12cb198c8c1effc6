"""Deliveries in a home: the errand between two zones, or a mission."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Tuple

from add_markers import CarriedParcel
from evaluation.verdict import collision
from headless_mission import (
    NAVIGATION_CONFIG,
    EpisodeConditions,
    EpisodeResult,
    HeadlessMission,
    parcel_for,
)
from laboratory.tasks.shortest_paths import shortest_path_length
from laboratory.tasks.task import RunConditions, RunTrace, outcome_of
from laboratory.worlds.source import Arena
from pick_objects import Mission, errand_mission, load_mission
from planar import OccupancyGrid, Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.maps.places import load_pickup_and_dropoff, load_places, unreachable_reason
from sim_bridge import robot_named


@dataclass(frozen=True)
class DeliveryTask:
    """The errand or a mission in a given home.

    Attributes:
        zones: File of the zones; without a mission the errand goes from the pick-up to the drop-off zone.
        mission: File of the mission; None: the errand.
    """

    zones: Path
    mission: Optional[Path] = None

    def run(self, scenario: RunConditions, arena: Arena, seed: int) -> RunTrace:
        mission = self._mission(arena)
        parcel = None if self.mission else parcel_for(mission)
        return replace(
            run_mission(scenario, arena, seed, mission, parcel),
            reference_length=self.reference_length(scenario, arena),
        )

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        places = self._mission(arena).places.values()
        return [pose for place in places for pose in place.poses]

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        """Return the shortest path of the errand [m]; None for a mission, whose best order is not known."""
        if self.mission is not None:
            return None
        robot = EpisodeConditions(parameters=scenario.parameters).navigation(NAVIGATION_CONFIG)
        ends = tuple(place.pose for place in load_pickup_and_dropoff(self.zones))
        return shortest_path_length(
            _grid_of(arena), (scenario.start, *ends), robot.global_costmap.robot_radius
        )

    def files(self) -> Tuple[Path, ...]:
        return (self.zones,) if self.mission is None else (self.zones, self.mission)

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Any]:
        self._mission(arena)
        if self.mission is None:
            return {"zones_file": self.zones, "marker_mode": "service"}
        return {"zones_file": self.zones, "mission_file": self.mission, "marker_mode": "mission"}

    def _mission(self, arena: Arena) -> Mission:
        if self.mission is not None:
            return load_mission(self.mission, load_places(self.zones), grid=arena.grid)
        ends = load_pickup_and_dropoff(self.zones)
        problems = filter(None, (unreachable_reason(place, _grid_of(arena)) for place in ends))
        for problem in problems:
            raise SettingsError(f"{self.zones}: {problem}")
        return errand_mission(*ends)


def run_mission(
    scenario: RunConditions, arena: Arena, seed: int, mission: Mission, parcel: Optional[CarriedParcel] = None
) -> RunTrace:
    """Run a mission headless, with the conditions of a scenario.

    Args:
        scenario: Scenario with robot, faults, noise and parameters.
        arena: World and map.
        seed: Seed of the run.
        mission: Mission to carry out.
        parcel: Marker of the errand; None for other missions.

    Raises:
        PlanarError: The mission cannot be run.
    """
    inputs = (arena.world, robot_named(scenario.robot), _grid_of(arena), mission)
    episode = HeadlessMission(*inputs, seed=seed, parcel=parcel, conditions=_conditions(scenario))
    run = episode.run(scenario.seconds)
    return RunTrace(
        outcome_of(
            run.verdict.success, run.mission_record.collisions, run.simulated_seconds, scenario.seconds
        ),
        _reason(run),
        run.trajectory,
        run.localization_error,
        run.mission_record.collisions,
        people=run.people,
        people_at_fault=run.people_at_fault,
    )


def _conditions(scenario: RunConditions) -> EpisodeConditions:
    return EpisodeConditions(
        scenario.planner, scenario.parameters, scenario.faults, scenario.simulation, scenario.start
    )


def _grid_of(arena: Arena) -> OccupancyGrid:
    if arena.grid is None:
        raise SettingsError(f"{arena.title}: the task needs a world with a map")
    return arena.grid


def _reason(run: EpisodeResult) -> str:
    """The reason of the verdict, preceded by a collision that it does not mention."""
    cause, reason = collision(run.mission_record.collisions), run.verdict.reason
    return reason if cause is None or cause in reason else f"{cause}; {reason}"


def read_errand(table: Table, folder: Path) -> DeliveryTask:
    """Read ``errand``: a file of zones."""
    table.allow_only("errand")
    return DeliveryTask(table.path("errand", folder))


def read_mission(table: Table, folder: Path) -> DeliveryTask:
    """Read ``mission``, a mission file, and the ``zones`` it refers to."""
    table.allow_only("mission", "zones")
    return DeliveryTask(table.path("zones", folder), table.path("mission", folder))
