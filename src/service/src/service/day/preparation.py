"""Preparation of a simulated day: world with dock, robot, service, generated requests, furniture."""

import math
from dataclasses import dataclass, field
from typing import List, Mapping, Sequence

import numpy as np

from auto_docking_lite.poses import pose_when_docked, staging_pose
from headless_mission import EpisodeConditions
from move_base_lite import NavigatorSettings
from planar import OccupancyGrid, Pose2
from planar.maps.places import NamedPlace
from service.day.episode_robot import EpisodeRobot
from service.day.requests_by_hour import DayGenerator, DaySettings
from service.day.simulated_day import FurnitureMove, SimulatedDay
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.calendar_times import DAY
from service.requests.parser import Knowledge
from sim_bridge import RobotProfile, Simulation
from sim_bridge.docks import with_dock
from sim_bridge.faults import FaultInjector
from sim_bridge.world import World

# Midnight at which days begin, 2026-12-01 UTC [Unix time].
MIDNIGHT = 1796083200.0
# Hours between which furniture is moved, distance by which it is [m], and of the robot from its contacts [m].
FURNITURE_HOURS, FURNITURE_DISTANCE, BEFORE_CONTACTS = (7.0, 22.0), 0.3, 0.01


@dataclass(frozen=True, eq=False)
class DayPlan:
    """What a day is made from.

    Attributes:
        world: The world without the dock.
        robot: The robot.
        grid: Map.
        places: Places by name.
        dock: Pose of the dock.
        requests: How busy the day is.
        furniture: Poses of models that are moved, by name.
        moves: How often furniture is moved.
    """

    world: World
    robot: RobotProfile
    grid: OccupancyGrid
    places: Mapping[str, NamedPlace]
    dock: Pose2
    requests: DaySettings = DaySettings()
    furniture: Mapping[str, Pose2] = field(default_factory=dict)
    moves: int = 0


def prepare_day(
    plan: DayPlan, navigation: NavigatorSettings, conditions: EpisodeConditions, seed: int
) -> SimulatedDay:
    """Return a day that begins at midnight with the robot in its dock.

    Args:
        plan: What the day is made from.
        navigation: Parameters of move_base.
        conditions: Faults, noise and rates.
        seed: Seed of the day.

    Raises:
        WorldError: The robot cannot stand in the dock.
    """
    start = pose_when_docked(plan.dock) @ Pose2(-BEFORE_CONTACTS)
    faults = FaultInjector(conditions.faults, seed)
    world = with_dock(plan.world, plan.dock)
    simulation = Simulation(world, plan.robot, conditions.simulation, seed, start, faults.wrappers)
    robot = EpisodeRobot(navigation, plan.grid, seed, start, plan.dock)
    model = PlanningModel(GridTravelTimes(plan.grid), dock=staging_pose(plan.dock))
    service = RequestService(Site(plan.places, model, Knowledge(tuple(plan.places), True)))
    generator = DayGenerator(list(plan.places), np.random.default_rng([seed, 51]), plan.requests)
    requests = generator.requests(MIDNIGHT)
    furniture = furniture_moves(plan, np.random.default_rng([seed, 52]))
    return SimulatedDay(simulation, robot, service, MIDNIGHT, requests, furniture, faults)


def furniture_moves(plan: DayPlan, rng: np.random.Generator) -> List[FurnitureMove]:
    """Return when furniture is moved, and to where: near the place at which it stood first.

    Args:
        plan: The furniture and how often it is moved.
        rng: Chance.
    """
    names: Sequence[str] = sorted(plan.furniture)
    if not names:
        return []
    stamps = sorted(MIDNIGHT + DAY / 24.0 * hours for hours in rng.uniform(*FURNITURE_HOURS, plan.moves))
    moves = []
    for stamp in stamps:
        name = names[int(rng.integers(len(names)))]
        offset = Pose2(*rng.uniform(-FURNITURE_DISTANCE, FURNITURE_DISTANCE, 2).tolist())
        turn = Pose2(0.0, 0.0, float(rng.uniform(-math.pi, math.pi)))
        moves.append(FurnitureMove(float(stamp), name, plan.furniture[name] @ offset @ turn))
    return moves
