"""The whole mission in one process, without ROS: the same cores as in the nodes, stepped in lock-step.

Bit-for-bit repeatable from a seed, and many times faster than real time. What takes effect when is as over
ROS (docs/explanation/deterministic_runs.md): what one part tells, the others know one control period later.
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

from add_markers import CarriedParcel, Solid
from amcl_lite import Localizer, LocalizerSettings
from amcl_lite.config import InitialPose
from amcl_lite.errors import LocalizationError
from home_service.judging.company import Company
from home_service.judging.delivery_watch import DeliveryWatch
from home_service.judging.verdict import ERRAND, MARKERS, Ledger, Verdict, judge
from home_service.rehearsal.bodies import RehearsedBodies, solids_of
from home_service.rehearsal.senses import Senses
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
    Arrival,
    Errand,
    FinishTask,
    Fit,
    GoalFailed,
    GoalReached,
    GoTo,
    MeasureWays,
    Mission,
    SendAgain,
    WaysMeasured,
)
from pick_objects.arrival import Judged
from pick_objects.errand import Order
from planar import OccupancyGrid, Pose2, Scan, Twist2
from planar.config.settings_file import settings_from_yaml
from sim_bridge import RobotProfile, Simulation, SimulationSettings, StepResult
from sim_bridge.config import LATENCY
from sim_bridge.faults import Fault, FaultContext, FaultInjector
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.simulation import ROBOT_NAME
from sim_bridge.world import World

PACKAGES = Path(__file__).resolve().parents[4]
LOCALIZATION_CONFIG = PACKAGES / "amcl_lite/config/turtlebot.yaml"
NAVIGATION_CONFIG = PACKAGES / "move_base_lite/config/turtlebot.yaml"


# Control periods from when a navigator is there until its client has heard of it; and from when a box is
# picked up or set down until it has been moved.
PERIODS_TO_FIND, PERIODS_TO_MOVE = 2, 2


@dataclass(frozen=True)
class Conditions:
    """Under which conditions a mission is rehearsed, other than the usual.

    ``planner``: another local one; ``parameters``: of move_base, over those of the robot; ``faults``: what
    goes wrong; ``simulation``: noise and rates; ``start``: where the robot stands, and knows that it does.
    """

    planner: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    faults: Sequence[Fault] = ()
    simulation: SimulationSettings = SimulationSettings()
    start: Pose2 = Pose2()

    def navigation(self, config: Path) -> NavigatorSettings:
        """The parameters of a robot's file, with these over them. Raises SettingsError."""
        if self.planner:
            check_local_planner(self.planner)
        planner = {"base_local_planner": self.planner} if self.planner else {}
        return _navigation(config, json.dumps({**self.parameters, **planner}))


@dataclass(frozen=True, eq=False)
class Rehearsed:
    """How a rehearsal went.

    ``trajectory``: (N, 4) stamp, true x, y, yaw at each control period. ``localization_error``: (N,), metres.
    ``diagnosis``: the first sensor that was not trusted, and why. ``people``: (N, P, 5), and who of them
    ``ran_into_robot``: home_service.judging.company.
    """

    verdict: Verdict
    ledger: Ledger
    trajectory: np.ndarray
    localization_error: np.ndarray
    wall_seconds: float
    diagnosis: str = ""
    people: np.ndarray = field(default_factory=lambda: np.empty((0, 0, 5)))
    ran_into_robot: Sequence[str] = ()

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
        """The same for two runs only if every bit of the true trajectory is the same."""
        return hashlib.sha256(np.ascontiguousarray(self.trajectory).tobytes()).hexdigest()


class Rehearsal:
    """Simulation, Localizer, Navigator, Errand and Parcel, stepped together; nothing but a seed is random."""

    def __init__(
        self,
        world: World,
        robot: RobotProfile,
        grid: OccupancyGrid,
        mission: Mission,
        seed: int,
        parcel: Optional[CarriedParcel] = None,
        conditions: Conditions = Conditions(),
    ):
        """``parcel``: the marker of an errand that is rehearsed with it."""
        start = conditions.start
        self._faults = FaultInjector(conditions.faults, seed)
        self._simulation = Simulation(
            world,
            _with_what_it_uses(robot),
            conditions.simulation,
            seed,
            start,
            wrappers=self._faults.wrappers,
        )
        self._company = Company(self._simulation)
        self._localizer = _localizer(grid, seed, start)
        navigation = conditions.navigation(NAVIGATION_CONFIG)
        self._navigator = Navigator(navigation, grid)
        self._senses = Senses(navigation.move_base.sensor_patience)
        self._steps_per_tick = round(
            1.0 / (navigation.move_base.controller_frequency * self._simulation.step_seconds)
        )
        self._latency = min(LATENCY, 1.0 / navigation.move_base.controller_frequency)
        self._steps_of_latency = round(self._latency / self._simulation.step_seconds)
        self._command: Optional[Twist2] = None
        self._command_under_way: Optional[Twist2] = None
        self._sent_to, self._arrival = start, Arrival(start)
        self._goal: Optional[Pose2] = None
        self._event: Judged = None
        self._now, self._periods_up = 0.0, 0
        self._solids: Deque[List[Solid]] = deque()
        self._errand = Errand(mission)
        self._bodies = RehearsedBodies(self._simulation, grid)
        self._parcel = parcel
        self._places, self._ledger, self._fit = mission.places, Ledger(), Fit()
        self._deliveries = DeliveryWatch(mission.places, self._ledger.deliveries, say=lambda line: None)
        self._trajectory: List[Tuple[float, float, float, float]] = []
        self._errors: List[float] = []

    def run(self, simulated_timeout: float = 600.0) -> Rehearsed:
        """Plays the mission to its end."""
        start, outcome = time.perf_counter(), None
        while outcome is None:
            outcome = self._play_moment()
            if outcome is None and self._now > simulated_timeout:
                outcome = FinishTask(False, f"not done within {simulated_timeout:g} simulated seconds")
        if not outcome.success:
            self._ledger.failure = outcome.reason
        self._ledger.reason = outcome.reason
        self._simulation.close()
        return Rehearsed(
            judge(self._ledger, {ERRAND, MARKERS} if self._parcel else {ERRAND}),
            self._ledger,
            np.array(self._trajectory),
            np.array(self._errors),
            time.perf_counter() - start,
            self._senses.diagnosis,
            self._company.track,
            self._company.ran_into_robot,
        )

    def _play_moment(self) -> Optional[FinishTask]:
        """Moves on by one control period, after which each part does what it has to do; the end, if so."""
        odom_in_map = self._localizer.odom_in_map
        observation, scan = self._advance_simulation()
        self._now, odometry = observation.stamp, observation.odometry
        if odom_in_map is None:
            return None
        base_in_map = odom_in_map @ odometry.base_in_odom
        if scan is not None:
            scan = self._senses.as_seen_now(scan, self._now, odometry.base_in_odom)
        self._note(observation, base_in_map)
        if self._goal is not None:
            self._navigator.set_goal(self._goal)
        decision = self._navigator.tick(
            self._now, base_in_map, odometry.base_in_odom, odometry.twist, scan, latency=self._latency
        )
        complaint = self._senses.complaint(self._now)
        self._command = decision.command if complaint is None else Twist2()
        self._goal = self._sent_to if isinstance(self._event, SendAgain) else None
        order = self._advance_errand(base_in_map, observation.base_in_world)
        if isinstance(order, GoTo):
            self._goal, self._sent_to, self._arrival = order.pose, order.pose, Arrival(order.pose)
        self._event = self._arrival.judge(_event_of(decision), base_in_map, self._fit.least, self._now)
        if complaint is not None and self._senses.is_out_of_patience(self._now):
            # As move_base does with a sensor that it cannot trust.
            self._navigator.clear_goal()
            self._event = GoalFailed(f"waiting for a trustworthy sensor ({complaint})")
        return order if isinstance(order, FinishTask) else None

    def _advance_errand(self, base_in_map: Pose2, truth: Pose2) -> Optional[Order]:
        """Its next order, if any; it begins when it has found the navigator."""
        self._periods_up += 1
        if self._periods_up <= PERIODS_TO_FIND:
            return None
        order = self._errand.advance(self._now, None if isinstance(self._event, SendAgain) else self._event)
        while isinstance(order, MeasureWays):
            order = self._errand.advance(self._now, self._measure(order, base_in_map))
        self._note_state(truth)
        self._solids.append(solids_of(self._errand))
        if len(self._solids) > PERIODS_TO_MOVE:
            self._bodies.follow(self._solids.popleft(), truth)
        return order

    def _advance_simulation(self) -> Tuple[StepResult, Optional[Scan]]:
        """Moves on by one control period; returns the last observation and the scan made on the way."""
        scan = None
        for step in range(self._steps_per_tick):
            sent = self._command_under_way if step == 0 else None
            if step == self._steps_of_latency:
                sent = self._command
            observation = self._simulation.step(sent)
            self._ledger.collisions.extend(self._company.contacts(observation))
            self._senses.feel(observation, self._command or Twist2())
            if observation.scan is not None:
                scan = observation.scan
                self._localize(scan)
            place = FaultContext(self._simulation.scene, ROBOT_NAME, observation.base_in_world)
            self._faults.update(observation.stamp, place)
        is_under_way = self._steps_of_latency == self._steps_per_tick
        self._command_under_way = self._command if is_under_way else None
        return observation, scan

    def _localize(self, scan: Scan) -> None:
        with suppress(LocalizationError):  # the node says so, and goes on too
            self._localizer.update(self._senses.base_at(scan.stamp), scan)
            if self._localizer.quality is not None:
                self._fit.take(self._localizer.quality.probability)

    def _note(self, observation: StepResult, base_in_map: Pose2) -> None:
        truth = observation.base_in_world
        self._trajectory.append((observation.stamp, truth.x, truth.y, truth.yaw))
        self._errors.append(truth.distance_to(base_in_map))
        self._company.note()
        if self._parcel is not None:
            self._note_marker(self._parcel.update(observation.stamp, base_in_map))

    def _note_state(self, truth: Pose2) -> None:
        self._ledger.final_state = self._errand.state.value
        for job in self._errand.jobs:
            self._deliveries.see(job.delivery, job.stage, job.attempts, job.reason, truth)

    def _measure(self, order: MeasureWays, base_in_map: Pose2) -> WaysMeasured:
        lengths: List[Optional[float]] = []
        for start, end in order.ways:
            try:
                corners = self._navigator.make_plan(start or base_in_map, end)
                lengths.append(float(np.hypot(*np.diff(corners, axis=0).T).sum()))
            except NavigationError:
                lengths.append(None)
        return WaysMeasured(tuple(lengths))

    def _note_marker(self, shown_at: Optional[Pose2]) -> None:
        shown = [place.name for place in self._places.values() if place.pose == shown_at]
        event = f"shown at {shown[0]}" if shown else "hidden"
        if self._ledger.markers[-1:] != [event]:
            self._ledger.markers.append(event)


def _localizer(grid: OccupancyGrid, seed: int, start: Pose2) -> Localizer:
    """One that knows where it starts, about."""
    localizer = Localizer(grid, _localization(), np.random.default_rng(seed))
    if start != Pose2():
        localizer.set_pose(start, InitialPose().covariance)
    return localizer


@lru_cache(maxsize=1)
def _localization() -> LocalizerSettings:
    """Read once, however many missions a process plays."""
    return settings_from_yaml(LocalizerSettings, LOCALIZATION_CONFIG)[0]


@lru_cache(maxsize=8)
def _navigation(config: Path, chosen: str) -> NavigatorSettings:
    """As above; ``chosen``: parameters, as JSON."""
    return load_settings(config, **json.loads(chosen))


def _with_what_it_uses(robot: RobotProfile) -> RobotProfile:
    """The robot without the sensors that nobody asks here: bumpers, cliff sensors and cameras take time."""
    return replace(robot, sensors=robot.sensors_of(LaserProfile))


def parcel_of(errand: Mission) -> CarriedParcel:
    """The marker of the errand between the two zones."""
    pickup, dropoff = errand.places.values()
    return CarriedParcel(pickup, dropoff, errand.settings.pickup_seconds)


def _event_of(decision: Decision):
    if decision.status is Status.SUCCEEDED:
        return GoalReached()
    return GoalFailed(decision.text) if decision.status is Status.ABORTED else None
