"""A headless mission: the nodes' behaviour in one process, without ROS, stepped in lock-step.

The result depends on nothing but the seed, bit for bit. Delays are those of the nodes
(docs/explanation/deterministic_runs.md): what one component computes, the others use one control period
later.
"""

import time
from dataclasses import replace
from typing import Optional

from add_markers import CarriedParcel
from evaluation.presets import NAVIGATION_CONFIG
from headless_mission.boxes import BoxHooks
from headless_mission.conditions import EpisodeConditions
from headless_mission.errand import ErrandHooks
from headless_mission.localization import LocalizationHooks
from headless_mission.navigation import EpisodeMoveBaseClient, NavigationHooks
from headless_mission.observers import MissionObserver
from headless_mission.result import EpisodeResult
from pick_objects import FinishTask, Mission, search_area_of
from planar import OccupancyGrid
from planar.maps.semantic_map import SemanticMap
from sim_bridge import Episode, RobotProfile, Simulation
from sim_bridge.config import LATENCY
from sim_bridge.faults import FaultInjector
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.object_detector import ObjectDetectorProfile
from sim_bridge.world import World


class HeadlessMission:
    """Runs simulation, localization, navigation and errand together.

    Args:
        world: World to simulate.
        robot: Robot in it.
        grid: Map for localization and navigation.
        mission: Deliveries to carry out.
        seed: Seed of noise, particles and faults.
        parcel: Marker of an errand, checked by the verdict; None: no marker.
        conditions: Deviations from the defaults.
        semantic_map: What is usually where, to search objects by; None: nothing can be searched.
    """

    def __init__(
        self,
        world: World,
        robot: RobotProfile,
        grid: OccupancyGrid,
        mission: Mission,
        seed: int,
        parcel: Optional[CarriedParcel] = None,
        conditions: EpisodeConditions = EpisodeConditions(),
        semantic_map: Optional[SemanticMap] = None,
    ):
        start, settings = conditions.start, conditions.navigation(NAVIGATION_CONFIG)
        encoding, grid = conditions.encoding, conditions.encoding.grid(grid)
        faults, robot = FaultInjector(conditions.faults, seed), _without_unused_sensors(robot)
        self._simulation = simulation = Simulation(
            world, robot, conditions.simulation, seed, start, faults.wrappers
        )
        navigation = NavigationHooks(settings, grid, encoding, conditions.zones)
        client = EpisodeMoveBaseClient(navigation, encoding)
        area = search_area_of(grid, semantic_map)
        self._errand = errand = ErrandHooks(mission, navigation, client, conditions.mission_start, area)
        objects = [each for detector in robot.sensors_of(ObjectDetectorProfile) for each in detector.objects]
        self._observer = MissionObserver(simulation, navigation, errand, parcel, objects)
        boxes = BoxHooks(simulation, grid, errand)
        on_fit = errand.driver.add_fit
        localization = LocalizationHooks(grid, seed, start, navigation.poses, on_fit, encoding)
        # What localization computes takes effect at the next tick, as it comes last; the client, which comes
        # first, passes on what was sent at the last one.
        hooks = client, navigation, errand, self._observer, boxes, localization
        latency = min(LATENCY, navigation.period)
        self._episode = Episode(simulation, navigation.period, latency, faults, hooks)

    def run(self, simulated_timeout: float = 600.0) -> EpisodeResult:
        """Run the episode until the mission ends.

        Args:
            simulated_timeout: Simulated time after which the mission has failed [s].
        """
        start = time.perf_counter()
        while self._errand.end is None:
            stamp = self._episode.advance().stamp
            if self._errand.end is None and stamp > simulated_timeout:
                reason = f"not done within {simulated_timeout:g} simulated seconds"
                self._errand.end = FinishTask(False, reason)
        self._simulation.close()
        return self._observer.result(self._errand.end, time.perf_counter() - start)


def _without_unused_sensors(robot: RobotProfile) -> RobotProfile:
    """Drop bumpers, cliff sensors and cameras, which nothing reads here and which cost time."""
    return replace(robot, sensors=(*robot.sensors_of(LaserProfile), *robot.sensors_of(ObjectDetectorProfile)))


def parcel_for(errand: Mission) -> CarriedParcel:
    """Create the marker of an errand between two zones."""
    pickup, dropoff = errand.places.values()
    return CarriedParcel(pickup, dropoff, errand.settings.pickup_seconds)
