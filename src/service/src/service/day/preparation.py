"""Preparation of a simulated day: world with dock, robot, service, generated requests."""

from dataclasses import dataclass
from typing import List, Mapping, Sequence

import numpy as np

from auto_docking_lite.poses import pose_when_docked, staging_pose
from headless_mission import EpisodeConditions
from move_base_lite import NavigatorSettings
from planar import OccupancyGrid, Pose2
from planar.maps.places import NamedPlace
from service.day.episode_robot import EpisodeRobot
from service.day.requests_by_hour import DayGenerator, DaySettings
from service.day.simulated_day import SimulatedDay
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.parser import Knowledge
from service.requests.timed_requests import TimedRequest
from sim_bridge import RobotProfile, Simulation
from sim_bridge.docks import with_dock
from sim_bridge.faults import FaultInjector
from sim_bridge.world import World

# Midnight at which days begin, 2026-12-01 UTC [Unix time].
MIDNIGHT = 1796083200.0
# Distance of the robot from the contacts of the dock at the start [m].
BEFORE_CONTACTS = 0.01


@dataclass(frozen=True, eq=False)
class DayPlan:
    """What a day is made from.

    Attributes:
        world: The world without the dock.
        robot: The robot.
        grid: Map.
        places: Places by name.
        dock: Pose of the dock.
    """

    world: World
    robot: RobotProfile
    grid: OccupancyGrid
    places: Mapping[str, NamedPlace]
    dock: Pose2


def start_pose(dock: Pose2) -> Pose2:
    """Return where the robot of a day starts in the world.

    Args:
        dock: Pose of the dock in the world.
    """
    return pose_when_docked(dock) @ Pose2(-BEFORE_CONTACTS)


def generated_requests(places: Sequence[str], settings: DaySettings, seed: int) -> List[TimedRequest]:
    """Return the requests of a day, in the order of their stamps.

    Args:
        places: Names of the places.
        settings: How busy the day is.
        seed: Seed of the day.
    """
    return DayGenerator(places, np.random.default_rng([seed, 51]), settings).requests(MIDNIGHT)


def prepare_day(
    plan: DayPlan,
    requests: Sequence[TimedRequest],
    navigation: NavigatorSettings,
    conditions: EpisodeConditions,
    seed: int,
) -> SimulatedDay:
    """Return a day that begins at midnight with the robot in its dock.

    Args:
        plan: What the day is made from.
        requests: Requests in the order of their stamps.
        navigation: Parameters of move_base.
        conditions: Faults, noise and rates.
        seed: Seed of the day.

    Raises:
        WorldError: The robot cannot stand in the dock.
    """
    start = start_pose(plan.dock)
    faults = FaultInjector(conditions.faults, seed)
    world = with_dock(plan.world, plan.dock)
    simulation = Simulation(world, plan.robot, conditions.simulation, seed, start, faults.wrappers)
    robot = EpisodeRobot(navigation, plan.grid, seed, start, plan.dock)
    model = PlanningModel(GridTravelTimes(plan.grid), dock=staging_pose(plan.dock))
    service = RequestService(Site(plan.places, model, Knowledge(tuple(plan.places), True)))
    return SimulatedDay(simulation, robot, service, MIDNIGHT, requests, faults)
