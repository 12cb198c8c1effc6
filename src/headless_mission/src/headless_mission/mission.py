"""Headless simulation of a mission: the cores of the nodes in one process, without ROS, stepped in lock-step.

The result depends on nothing but the seed, bit for bit. Delays are those of the nodes
(docs/explanation/deterministic_runs.md): what one component computes, the others use one control period
later.
"""

import hashlib
import json
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Deque, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from add_markers import CarriedParcel, SolidBox
from amcl_lite import Localizer, LocalizerSettings
from amcl_lite.config import InitialPose
from amcl_lite.errors import LocalizationError
from evaluation.delivery_monitor import DeliveryMonitor
from evaluation.pedestrian_contacts import PedestrianContacts
from evaluation.presets import LOCALIZATION_CONFIG, NAVIGATION_CONFIG
from evaluation.verdict import ERRAND, MARKERS, MissionRecord, Verdict, judge
from headless_mission.boxes import HeadlessBoxes, boxes_of
from headless_mission.sensor_buffer import SensorBuffer
from move_base_lite import (
    Decision,
    NavigationError,
    Navigator,
    NavigatorSettings,
    Status,
    load_settings,
)
from move_base_lite.control import check_local_planner
from pick_objects import (
    ArrivalCheck,
    DriveToPlace,
    Errand,
    FinishTask,
    GoalFailed,
    GoalReached,
    MeasurePathLengths,
    Mission,
    PathLengthsMeasured,
    RecentScanFit,
    ResendGoal,
)
from pick_objects.arrival import ArrivalEvent
from pick_objects.errand import Order
from planar import OccupancyGrid, Pose2, Scan, Twist2
from planar.config.parameters import settings_from_yaml
from sim_bridge import RobotProfile, Simulation, SimulationSettings, StepResult
from sim_bridge.config import LATENCY
from sim_bridge.faults import Fault, FaultContext, FaultInjector
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import World

# Control periods until the errand has connected to the navigator, and until a box that was picked up or set
# down has been moved.
CONNECTION_PERIODS, BOX_MOVE_PERIODS = 2, 2


@dataclass(frozen=True)
class EpisodeConditions:
    """Deviations of an episode from the defaults.

    Attributes:
        planner: Local planner instead of the preset's; empty: the preset's.
        parameters: Parameters of move_base that override those of the preset.
        faults: Faults to inject.
        simulation: Noise and rates of the simulation.
        start: Initial pose of the robot in the world, which is also the initial estimate.
    """

    planner: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    faults: Sequence[Fault] = ()
    simulation: SimulationSettings = SimulationSettings()
    start: Pose2 = Pose2()

    def navigation(self, config: Path) -> NavigatorSettings:
        """Read a preset and apply these conditions to it.

        Args:
            config: YAML file of move_base's parameters.

        Raises:
            SettingsError: If a parameter or the planner is not valid.
        """
        if self.planner:
            check_local_planner(self.planner)
        planner = {"base_local_planner": self.planner} if self.planner else {}
        return _navigation(config, json.dumps({**self.parameters, **planner}))


@dataclass(frozen=True, eq=False)
class EpisodeResult:
    """Outcome of an episode.

    Attributes:
        verdict: Whether the mission succeeded, judged by ground truth.
        mission_record: Deliveries, collisions and markers that the verdict is based on.
        trajectory: (N, 4), stamp [s] and true x, y, yaw of the base in the world at each control period.
        localization_error: (N,), distance between estimated and true position [m].
        wall_seconds: Wall-clock time of the episode [s].
        diagnosis: First sensor that was found implausible, and why; empty if none.
        people: (N, P, 5), x, y, velocity in x and y, radius of each of P pedestrians.
        people_at_fault: Pedestrians that walked into the robot (evaluation.pedestrian_contacts).
    """

    verdict: Verdict
    mission_record: MissionRecord
    trajectory: np.ndarray
    localization_error: np.ndarray
    wall_seconds: float
    diagnosis: str = ""
    people: np.ndarray = field(default_factory=lambda: np.empty((0, 0, 5)))
    people_at_fault: Sequence[str] = ()

    @property
    def simulated_seconds(self) -> float:
        return float(self.trajectory[-1, 0])

    @property
    def real_time_factor(self) -> float:
        return self.simulated_seconds / self.wall_seconds

    @property
    def distance_driven(self) -> float:
        steps = np.diff(self.trajectory[:, 1:3], axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    @property
    def trajectory_hash(self) -> str:
        """SHA-256 of the true trajectory: equal for two episodes only if they agree to the last bit."""
        return hashlib.sha256(np.ascontiguousarray(self.trajectory).tobytes()).hexdigest()


class HeadlessMission:
    """Steps simulation, localization, navigation and errand together, one control period at a time.

    Args:
        world: World to simulate.
        robot: Robot in it.
        grid: Map for localization and navigation.
        mission: Deliveries to carry out.
        seed: Seed of noise, particles and faults.
        parcel: Marker of an errand, checked by the verdict; None: no marker.
        conditions: Deviations from the defaults.
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
    ):
        start, navigation = conditions.start, conditions.navigation(NAVIGATION_CONFIG)
        self._faults = FaultInjector(conditions.faults, seed)
        self._simulation = Simulation(
            world,
            _without_unused_sensors(robot),
            conditions.simulation,
            seed,
            start,
            wrappers=self._faults.wrappers,
        )
        self._pedestrians = PedestrianContacts(self._simulation)
        self._localizer = _localizer(grid, seed, start)
        self._navigator = Navigator(navigation, grid)
        self._sensors = SensorBuffer(navigation.move_base.sensor_patience)
        self._set_rates(navigation.move_base.controller_frequency)
        self._command: Optional[Twist2] = None
        self._command_in_flight: Optional[Twist2] = None
        self._sent_to, self._arrival = start, ArrivalCheck(start)
        self._goal: Optional[Pose2] = None
        self._event: ArrivalEvent = None
        self._now, self._periods_running = 0.0, 0
        self._errand, self._parcel, self._places = Errand(mission), parcel, mission.places
        self._boxes, self._fit = HeadlessBoxes(self._simulation, grid), RecentScanFit()
        self._pending_boxes: Deque[List[SolidBox]] = deque()
        self._mission_record = MissionRecord()
        self._deliveries = DeliveryMonitor(self._places, self._mission_record.deliveries, lambda line: None)
        self._trajectory: List[Tuple[float, float, float, float]] = []
        self._errors: List[float] = []

    def _set_rates(self, controller_frequency: float) -> None:
        """Express the control period and the latency of commands in simulation steps."""
        step_seconds = self._simulation.step_seconds
        self._steps_per_tick = round(1.0 / (controller_frequency * step_seconds))
        self._latency = min(LATENCY, 1.0 / controller_frequency)
        self._steps_of_latency = round(self._latency / step_seconds)

    def run(self, simulated_timeout: float = 600.0) -> EpisodeResult:
        """Run the episode until the mission ends.

        Args:
            simulated_timeout: Simulated time after which the mission has failed [s].
        """
        start, outcome = time.perf_counter(), None
        while outcome is None:
            outcome = self._step_control_period()
            if outcome is None and self._now > simulated_timeout:
                outcome = FinishTask(False, f"not done within {simulated_timeout:g} simulated seconds")
        if not outcome.success:
            self._mission_record.failure = outcome.reason
        self._mission_record.reason = outcome.reason
        self._simulation.close()
        return EpisodeResult(
            judge(self._mission_record, {ERRAND, MARKERS} if self._parcel else {ERRAND}),
            self._mission_record,
            np.array(self._trajectory),
            np.array(self._errors),
            time.perf_counter() - start,
            self._sensors.diagnosis,
            self._pedestrians.track,
            self._pedestrians.people_at_fault,
        )

    def _step_control_period(self) -> Optional[FinishTask]:
        """Advance everything by one control period; return the end of the mission, if it has come."""
        odom_in_map = self._localizer.odom_in_map
        observation, scan = self._advance_simulation()
        self._now, odometry = observation.stamp, observation.odometry
        if odom_in_map is None:
            return None
        base_in_map = odom_in_map @ odometry.base_in_odom
        if scan is not None:
            scan = self._sensors.move_to_present(scan, self._now, odometry.base_in_odom)
        self._record_step(observation, base_in_map)
        if self._goal is not None:
            self._navigator.set_goal(self._goal)
        decision = self._navigator.tick(
            self._now, base_in_map, odometry.base_in_odom, odometry.twist, scan, latency=self._latency
        )
        implausibility = self._sensors.implausibility(self._now)
        self._command = decision.command if implausibility is None else Twist2()
        self._goal = self._sent_to if isinstance(self._event, ResendGoal) else None
        order = self._advance_errand(base_in_map, observation.base_in_world)
        if isinstance(order, DriveToPlace):
            self._goal, self._sent_to, self._arrival = order.pose, order.pose, ArrivalCheck(order.pose)
        self._event = self._arrival.check(
            _event_of(decision), base_in_map, self._fit.minimum, self._now, odometry.base_in_odom
        )
        if implausibility is not None and self._sensors.is_patience_exceeded(self._now):
            # As move_base does if a sensor stays implausible.
            self._navigator.clear_goal()
            self._event = GoalFailed(f"waiting for a trustworthy sensor ({implausibility})")
        return order if isinstance(order, FinishTask) else None

    def _advance_errand(self, base_in_map: Pose2, truth: Pose2) -> Optional[Order]:
        """Return the errand's next order, if any; it starts when it has connected to the navigator."""
        self._periods_running += 1
        if self._periods_running <= CONNECTION_PERIODS:
            return None
        order = self._errand.advance(self._now, None if isinstance(self._event, ResendGoal) else self._event)
        while isinstance(order, MeasurePathLengths):
            order = self._errand.advance(self._now, self._measure(order, base_in_map))
        self._record_deliveries(truth)
        self._pending_boxes.append(boxes_of(self._errand))
        if len(self._pending_boxes) > BOX_MOVE_PERIODS:
            self._boxes.update(self._pending_boxes.popleft(), truth)
        return order

    def _advance_simulation(self) -> Tuple[StepResult, Optional[Scan]]:
        """Simulate one control period; return its last step and the scan taken in it, if any."""
        scan = None
        for step in range(self._steps_per_tick):
            sent = self._command_in_flight if step == 0 else None
            if step == self._steps_of_latency:
                sent = self._command
            observation = self._simulation.step(sent)
            self._mission_record.collisions.extend(self._pedestrians.robot_collisions(observation))
            self._sensors.update(observation, self._command or Twist2())
            if observation.scan is not None:
                scan = observation.scan
                self._localize(scan)
            place = FaultContext(self._simulation.scene, ROBOT_NAME, observation.base_in_world)
            self._faults.update(observation.stamp, place)
        is_in_flight = self._steps_of_latency == self._steps_per_tick
        self._command_in_flight = self._command if is_in_flight else None
        return observation, scan

    def _localize(self, scan: Scan) -> None:
        with suppress(LocalizationError):  # the node logs it and continues, too
            self._localizer.update(self._sensors.base_in_odom_at(scan.stamp), scan)
            if self._localizer.quality is not None:
                self._fit.add(self._localizer.quality.probability)

    def _record_step(self, observation: StepResult, base_in_map: Pose2) -> None:
        truth = observation.base_in_world
        self._trajectory.append((observation.stamp, truth.x, truth.y, truth.yaw))
        self._errors.append(truth.distance_to(base_in_map))
        self._pedestrians.record()
        if self._parcel is not None:
            self._record_marker(self._parcel.update(observation.stamp, base_in_map))

    def _record_deliveries(self, truth: Pose2) -> None:
        self._mission_record.final_state = self._errand.state.value
        for job in self._errand.jobs:
            self._deliveries.update(job.delivery, job.stage, job.attempts, job.reason, truth)

    def _measure(self, order: MeasurePathLengths, base_in_map: Pose2) -> PathLengthsMeasured:
        lengths: List[Optional[float]] = []
        for start, end in order.legs:
            try:
                corners = self._navigator.make_plan(start or base_in_map, end)
                lengths.append(float(np.hypot(*np.diff(corners, axis=0).T).sum()))
            except NavigationError:
                lengths.append(None)
        return PathLengthsMeasured(tuple(lengths))

    def _record_marker(self, shown_at: Optional[Pose2]) -> None:
        shown = [place.name for place in self._places.values() if place.pose == shown_at]
        event = f"shown at {shown[0]}" if shown else "hidden"
        if self._mission_record.markers[-1:] != [event]:
            self._mission_record.markers.append(event)


def _localizer(grid: OccupancyGrid, seed: int, start: Pose2) -> Localizer:
    """Create a localizer with an initial estimate at ``start``."""
    localizer = Localizer(grid, _localization(), np.random.default_rng(seed))
    if start != Pose2():
        localizer.set_pose(start, InitialPose().covariance)
    return localizer


@lru_cache(maxsize=1)
def _localization() -> LocalizerSettings:
    """Read the settings once a process."""
    return settings_from_yaml(LocalizerSettings, LOCALIZATION_CONFIG)[0]


@lru_cache(maxsize=8)
def _navigation(config: Path, chosen: str) -> NavigatorSettings:
    """Read the settings once for each set of parameters (``chosen``, as JSON)."""
    return load_settings(config, **json.loads(chosen))


def _without_unused_sensors(robot: RobotProfile) -> RobotProfile:
    """Drop bumpers, cliff sensors and cameras, which nothing reads here and which cost time."""
    return replace(robot, sensors=robot.sensors_of(LaserProfile))


def parcel_for(errand: Mission) -> CarriedParcel:
    """Create the marker of an errand between two zones."""
    pickup, dropoff = errand.places.values()
    return CarriedParcel(pickup, dropoff, errand.settings.pickup_seconds)


def _event_of(decision: Decision):
    if decision.status is Status.SUCCEEDED:
        return GoalReached()
    return GoalFailed(decision.text) if decision.status is Status.ABORTED else None
