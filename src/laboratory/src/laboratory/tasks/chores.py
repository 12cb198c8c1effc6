"""Deliveries between the places of a generated home."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Sequence, Tuple

import numpy as np

from laboratory.tasks.deliveries import play_mission
from laboratory.tasks.task import Play
from laboratory.worlds.source import Arena
from pick_objects import Delivery, Mission
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table

if TYPE_CHECKING:
    from laboratory.scenario.scenario import Scenario

_STREAM = 43


@dataclass(frozen=True)
class Chores:
    """``count``: deliveries, each from one of the places to another."""

    count: int = 4

    def play(self, scenario: "Scenario", arena: Arena, seed: int) -> Play:
        if len(arena.places) < 2:
            raise SettingsError(f"{arena.title}: chores need a world with places")
        rng = np.random.default_rng([seed, _STREAM])
        names = [place.name for place in arena.places]
        deliveries = []
        for number in range(1, self.count + 1):
            source, destination = rng.choice(names, 2, replace=False).tolist()
            deliveries.append(Delivery(f"chore {number}", f"thing {number}", source, destination))
        places = {place.name: place for place in arena.places}
        return play_mission(scenario, arena, seed, Mission("chores", places, tuple(deliveries)))

    def places(self, arena: Arena) -> Sequence[Pose2]:
        return [place.pose for place in arena.places]

    def files(self) -> Tuple[Path, ...]:
        return ()


def read_chores(table: Table, folder: Path) -> Chores:
    """``chores``: how many deliveries."""
    table.allow_only("chores")
    return Chores(table.count("chores"))
