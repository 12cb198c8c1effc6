"""What can happen to a robot, put together piece by piece: boxes, people, faults, noise."""

import math
from dataclasses import dataclass, replace
from typing import Any, Dict, List, Mapping, NamedTuple, Tuple, Union

import numpy as np
from optuna.distributions import (
    BaseDistribution,
    CategoricalDistribution,
    FloatDistribution,
    IntDistribution,
)

from laboratory.scenario.scenario import Scenario
from laboratory.worlds.boxes import apart_from, spots_for_boxes
from laboratory.worlds.people import TO_START, People, Walk
from planar import Pose2
from sim_bridge.faults import KINDS, Fault
from sim_bridge.noise import DEPRECATED_PROFILES, noise_named

# Simulated seconds within which a fault begins, and for how long it lasts.
BEGIN, LAST = (2.0, 20.0), (1.0, 8.0)
FASTEST_WALK, SLOWEST_WALK = 1.4, 0.5
SEEDS = 1000


class Noise(NamedTuple):
    """A profile of noise other than the usual."""

    name: str


Piece = Union[Pose2, Walk, Fault, Noise]


@dataclass(frozen=True)
class Case:
    """A scenario's seed, and what happens in it: a box for each Pose2, a person for each Walk, ..."""

    seed: int
    pieces: Tuple[Piece, ...]

    def of(self, kind: type) -> Tuple[Any, ...]:
        return tuple(piece for piece in self.pieces if isinstance(piece, kind))

    def scenario(self, base: Scenario) -> Scenario:
        """The base with nothing happening but this."""
        noises = self.of(Noise)
        simulation = base.simulation
        if noises:
            simulation = replace(simulation, **noise_named(noises[0].name))
        return replace(
            base,
            boxes=0,
            boxes_at=self.of(Pose2),
            doors=0,
            people=People(walks=self.of(Walk)),
            faults=self.of(Fault),
            simulation=simulation,
            seeds=(self.seed,),
        )


@dataclass(frozen=True)
class Ingredients:
    """How many of each at most; ``noise``: whether there may be more of it."""

    boxes: int = 4
    people: int = 2
    faults: int = 1
    noise: bool = True

    def space(self) -> Dict[str, BaseDistribution]:
        """Shares (0 to 1) of width and height for places; what else there is to choose."""
        share = FloatDistribution(0.0, 1.0)
        space: Dict[str, BaseDistribution] = {"seed": IntDistribution(0, SEEDS - 1)}
        for number in range(self.boxes):
            space.update({f"box{number}/{axis}": share for axis in ("x", "y", "yaw")})
        for number in range(self.people):
            space.update({f"person{number}/{axis}": share for axis in ("x1", "y1", "x2", "y2")})
            space[f"person{number}/speed"] = FloatDistribution(SLOWEST_WALK, FASTEST_WALK)
        kinds = sorted(name for name, kind in KINDS.items() if kind.survivable)
        for number in range(self.faults):
            space[f"fault{number}/kind"] = CategoricalDistribution(["", *kinds])
            space[f"fault{number}/start"] = FloatDistribution(*BEGIN)
            space[f"fault{number}/seconds"] = FloatDistribution(*LAST)
        if self.noise:
            # Not "high", its name today: stored studies hold these choices.
            space["noise"] = CategoricalDistribution(["", "bad"])
        return space

    def case(self, base: Scenario, values: Mapping[str, Any]) -> Case:
        """Boxes always leave a way, people do not begin beside the robot, faults can be lived through."""
        pieces: List[Piece] = [*self._boxes(base, values), *self._walks(base, values)]
        for number in range(self.faults):
            kind, start = values[f"fault{number}/kind"], round(values[f"fault{number}/start"], 1)
            if kind:
                end = round(start + values[f"fault{number}/seconds"], 1)
                pieces.append(Fault(kind, start, end, KINDS[kind].strength[0]))
        if self.noise and values["noise"]:
            pieces.append(Noise(DEPRECATED_PROFILES.get(values["noise"], values["noise"])))
        return Case(values["seed"], tuple(pieces))

    def _boxes(self, base: Scenario, values: Mapping[str, Any]) -> List[Pose2]:
        if not self.boxes:
            return []
        arena = base.world.arena(values["seed"])
        spots_xy = spots_for_boxes(arena, (base.start, *base.task.places(arena)))
        boxes: List[Pose2] = []
        for number in range(self.boxes):
            if not len(spots_xy):
                break
            share, yaw = [values[f"box{number}/{axis}"] for axis in "xy"], values[f"box{number}/yaw"]
            box = Pose2(*_spot(spots_xy, share), round((2.0 * yaw - 1.0) * math.pi, 2))
            boxes.append(box)
            spots_xy = apart_from(spots_xy, box)
        return boxes

    def _walks(self, base: Scenario, values: Mapping[str, Any]) -> List[Walk]:
        if not self.people:
            return []
        all_xy = spots_for_boxes(base.world.arena(values["seed"]), ())
        first_xy = all_xy[np.hypot(*(all_xy - (base.start.x, base.start.y)).T) > TO_START]
        walks: List[Walk] = []
        for number in range(self.people):
            x1, y1, x2, y2, speed = (
                values[f"person{number}/{key}"] for key in ("x1", "y1", "x2", "y2", "speed")
            )
            walks.append(Walk((_spot(first_xy, (x1, y1)), _spot(all_xy, (x2, y2))), round(speed, 2)))
        return walks


def _spot(spots_xy: np.ndarray, share: Any) -> Tuple[float, float]:
    """The spot of some (N, 2) that is nearest to a share, each 0 to 1, of the width and height of all."""
    low, high = spots_xy.min(axis=0), spots_xy.max(axis=0)
    wanted = low + np.asarray(share) * (high - low)
    x, y = spots_xy[int(np.argmin(np.hypot(*(spots_xy - wanted).T)))].tolist()
    return round(x, 3), round(y, 3)
