"""Deliveries between the places of a generated building."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Tuple

import numpy as np
import yaml

from laboratory.tasks.deliveries import run_mission
from laboratory.tasks.task import RunConditions, RunTrace
from laboratory.worlds.source import Arena
from pick_objects import Delivery, Mission
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.maps.places import places_table

_STREAM = 43


@dataclass(frozen=True)
class GeneratedDeliveryTask:
    """Random deliveries between the places of a generated building.

    Attributes:
        count: Number of deliveries.
    """

    count: int = 4

    def run(self, scenario: RunConditions, arena: Arena, seed: int) -> RunTrace:
        return run_mission(scenario, arena, seed, self._mission(arena, seed))

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        return [place.pose for place in arena.places]

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        return None

    def files(self) -> Tuple[Path, ...]:
        return ()

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Any]:
        mission = self._mission(arena, seed)
        places = places_table(mission.places.values())
        deliveries = [
            {"name": each.name, "object": each.object_name, "from": each.source, "to": each.destination}
            for each in mission.deliveries
        ]
        zones_file, mission_file = folder / "places.yaml", folder / "mission.yaml"
        zones_file.write_text(yaml.safe_dump(places), encoding="utf-8")
        content = {"name": mission.name, "deliveries": deliveries}
        mission_file.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        return {"zones_file": zones_file, "mission_file": mission_file, "marker_mode": "mission"}

    def _mission(self, arena: Arena, seed: int) -> Mission:
        if len(arena.places) < 2:
            raise SettingsError(f"{arena.title}: the task chores needs a world with places")
        rng = np.random.default_rng([seed, _STREAM])
        names = [place.name for place in arena.places]
        deliveries = []
        for number in range(1, self.count + 1):
            source, destination = rng.choice(names, 2, replace=False).tolist()
            deliveries.append(Delivery(f"chore {number}", f"object {number}", source, destination))
        places = {place.name: place for place in arena.places}
        return Mission("chores", places, tuple(deliveries))


def read_chores(table: Table, folder: Path) -> GeneratedDeliveryTask:
    """Read ``chores``: the number of deliveries."""
    table.allow_only("chores")
    return GeneratedDeliveryTask(table.count("chores"))
