"""Cases: combinations of boxes, pedestrians, faults and noise that disturb a scenario."""

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
from laboratory.worlds.boxes import free_box_positions, spaced_from
from laboratory.worlds.people import START_CLEARANCE, PedestrianRoute, Pedestrians
from planar import Pose2
from sim_bridge.faults import KINDS, Fault
from sim_bridge.noise import DEPRECATED_PROFILES, noise_named

# Ranges of the start and the duration of a fault [simulated s].
FAULT_START, FAULT_DURATION = (2.0, 20.0), (1.0, 8.0)
# Metres per second.
MAX_WALKING_SPEED, MIN_WALKING_SPEED = 1.4, 0.5
SEEDS = 1000


class NoiseProfile(NamedTuple):
    """A noise profile that replaces the scenario's."""

    name: str


CaseElement = Union[Pose2, PedestrianRoute, Fault, NoiseProfile]


@dataclass(frozen=True)
class Case:
    """A seed and the disturbances of a scenario.

    Attributes:
        seed: Seed of the run.
        elements: Boxes (Pose2), pedestrians (PedestrianRoute), faults and at most one noise profile.
    """

    seed: int
    elements: Tuple[CaseElement, ...]

    def of(self, kind: type) -> Tuple[Any, ...]:
        """Return the elements of one type."""
        return tuple(element for element in self.elements if isinstance(element, kind))

    def scenario(self, base: Scenario) -> Scenario:
        """Return the base scenario with the disturbances of this case only."""
        noises = self.of(NoiseProfile)
        simulation = base.simulation
        if noises:
            simulation = replace(simulation, **noise_named(noises[0].name))
        return replace(
            base,
            boxes=0,
            boxes_at=self.of(Pose2),
            doors=0,
            people=Pedestrians(routes=self.of(PedestrianRoute)),
            faults=self.of(Fault),
            simulation=simulation,
            seeds=(self.seed,),
        )


@dataclass(frozen=True)
class CaseSpace:
    """Search space of cases.

    Attributes:
        boxes: Maximum number of boxes.
        people: Maximum number of pedestrians.
        faults: Maximum number of faults.
        noise: Whether the noise profile ``high`` may be used.
    """

    boxes: int = 4
    people: int = 2
    faults: int = 1
    noise: bool = True

    def space(self) -> Dict[str, BaseDistribution]:
        """Return the distributions; positions are shares (0 to 1) of the world's width and height."""
        share = FloatDistribution(0.0, 1.0)
        space: Dict[str, BaseDistribution] = {"seed": IntDistribution(0, SEEDS - 1)}
        for number in range(self.boxes):
            space.update({f"box{number}/{axis}": share for axis in ("x", "y", "yaw")})
        for number in range(self.people):
            space.update({f"person{number}/{axis}": share for axis in ("x1", "y1", "x2", "y2")})
            space[f"person{number}/speed"] = FloatDistribution(MIN_WALKING_SPEED, MAX_WALKING_SPEED)
        kinds = sorted(name for name, kind in KINDS.items() if kind.survivable)
        for number in range(self.faults):
            space[f"fault{number}/kind"] = CategoricalDistribution(["", *kinds])
            space[f"fault{number}/start"] = FloatDistribution(*FAULT_START)
            space[f"fault{number}/seconds"] = FloatDistribution(*FAULT_DURATION)
        if self.noise:
            # Not "high", its name today: stored studies hold these choices.
            space["noise"] = CategoricalDistribution(["", "bad"])
        return space

    def case(self, base: Scenario, values: Mapping[str, Any]) -> Case:
        """Make a case of sampled values: boxes leave passages, pedestrians start away from the robot."""
        elements: List[CaseElement] = [*self._boxes(base, values), *self._pedestrian_routes(base, values)]
        for number in range(self.faults):
            kind, start = values[f"fault{number}/kind"], round(values[f"fault{number}/start"], 1)
            if kind:
                end = round(start + values[f"fault{number}/seconds"], 1)
                elements.append(Fault(kind, start, end, KINDS[kind].strength[0]))
        if self.noise and values["noise"]:
            elements.append(NoiseProfile(DEPRECATED_PROFILES.get(values["noise"], values["noise"])))
        return Case(values["seed"], tuple(elements))

    def _boxes(self, base: Scenario, values: Mapping[str, Any]) -> List[Pose2]:
        if not self.boxes:
            return []
        arena = base.world.arena(values["seed"])
        points_xy = free_box_positions(arena, (base.start, *base.task.required_poses(arena)))
        boxes: List[Pose2] = []
        for number in range(self.boxes):
            if not len(points_xy):
                break
            share, yaw = [values[f"box{number}/{axis}"] for axis in "xy"], values[f"box{number}/yaw"]
            box = Pose2(*_nearest_point(points_xy, share), round((2.0 * yaw - 1.0) * math.pi, 2))
            boxes.append(box)
            points_xy = spaced_from(points_xy, box)
        return boxes

    def _pedestrian_routes(self, base: Scenario, values: Mapping[str, Any]) -> List[PedestrianRoute]:
        if not self.people:
            return []
        all_xy = free_box_positions(base.world.arena(values["seed"]), ())
        first_xy = all_xy[np.hypot(*(all_xy - (base.start.x, base.start.y)).T) > START_CLEARANCE]
        routes: List[PedestrianRoute] = []
        for number in range(self.people):
            x1, y1, x2, y2, speed = (
                values[f"person{number}/{key}"] for key in ("x1", "y1", "x2", "y2", "speed")
            )
            routes.append(
                PedestrianRoute(
                    (_nearest_point(first_xy, (x1, y1)), _nearest_point(all_xy, (x2, y2))), round(speed, 2)
                )
            )
        return routes


def _nearest_point(points_xy: np.ndarray, share: Any) -> Tuple[float, float]:
    """The point of some (N, 2) nearest to a share (0 to 1) of their width and height."""
    low, high = points_xy.min(axis=0), points_xy.max(axis=0)
    target = low + np.asarray(share) * (high - low)
    x, y = points_xy[int(np.argmin(np.hypot(*(points_xy - target).T)))].tolist()
    return round(x, 3), round(y, 3)
