"""A day of service in the simulator, in one process: requests, furniture that is moved, idle time skipped."""

import math
from dataclasses import dataclass, field
from typing import List, Optional, Sequence, Tuple

from headless_mission.observers import ContactObserver
from planar import Pose2
from service.day.day_run import DayRecord, RecordedService, Store
from service.day.episode_robot import EpisodeRobot
from service.day.requests_by_hour import TimedRequest
from service.request_service import RequestService
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult
from sim_bridge.config import LATENCY
from sim_bridge.faults import FaultInjector
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.physics.kinematics import at_rest

# Idle time that is worth skipping, and time between two records of pose and charge [s].
SHORTEST_IDLE, RECORD_SECONDS = 3.0, 1.0
# Distance from the robot within which nothing is moved [m].
FURNITURE_CLEARANCE = 1.0


@dataclass(frozen=True)
class FurnitureMove:
    """A model that a person moves.

    Attributes:
        stamp: Unix time [s].
        model: Name of the model.
        pose: Where it stands afterwards, in the world.
    """

    stamp: float
    model: str
    pose: Pose2


@dataclass
class SimulatedDayRecord(DayRecord):
    """What came of a simulated day.

    Attributes:
        track: Unix time [s], true x, y [m] and yaw [rad], charge 0 to 1; one row a second that is stepped.
        activities: Unix time and text of each activity of the robot.
        contacts: Names of what the robot collided with by its own fault.
        empty_at: Unix time at which the battery was empty [s]; None if it never was.
        idle_seconds: Simulated time that was skipped [s].
        end: Unix time at which the day ended [s].
    """

    track: List[Tuple[float, float, float, float, float]] = field(default_factory=list)
    activities: List[Tuple[float, str]] = field(default_factory=list)
    contacts: List[str] = field(default_factory=list)
    empty_at: Optional[float] = None
    idle_seconds: float = 0.0
    end: float = 0.0


class SimulatedDay(EpisodeHooks):
    """Runs a service with a simulated robot.

    Args:
        simulation: The simulation, at time 0.
        robot: The robot in it.
        service: The service.
        start: Unix time of the simulation's time 0 [s].
        requests: Requests in the order of their stamps.
        furniture: Furniture that is moved, in the order of the stamps.
        faults: Faults, whose wrappers the simulation was built with.
        store: Called with what changed after each tick, before an order is carried out.

    Attributes:
        record: What came of it.
    """

    def __init__(
        self,
        simulation: Simulation,
        robot: EpisodeRobot,
        service: RequestService,
        start: float,
        requests: Sequence[TimedRequest],
        furniture: Sequence[FurnitureMove] = (),
        faults: Optional[FaultInjector] = None,
        store: Store = lambda changes, number: None,
    ):
        self.record = SimulatedDayRecord()
        self._service = RecordedService(service, requests, self.record, store)
        self._robot, self._origin, self._furniture = robot, start, list(furniture)
        self._observer = ContactObserver(simulation)
        period = robot.navigation.period
        hooks = (*robot.hooks, self, self._observer, robot.localization)
        self._episode = Episode(simulation, period, min(LATENCY, period), faults, hooks)

    @property
    def now(self) -> float:
        """Unix time [s]."""
        return self._origin + self._episode.simulation.scene.stamp

    def run(self, until: float) -> SimulatedDayRecord:
        """Run to a Unix time [s], or until the battery is empty.

        Args:
            until: Unix time [s].
        """
        while self.now < until and self.record.empty_at is None:
            self._episode.advance()
            self._skip_idle_time(until)
        self.record.contacts, self.record.end = sorted(set(self._observer.collisions)), self.now
        return self.record

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Let the service see the robot, and the robot its orders."""
        now, record = self._origin + step.stamp, self.record
        self._move_furniture(now)
        if step.power is not None and step.power.is_empty and record.empty_at is None:
            record.empty_at = now
        order = self._service.advance(now, self._robot.inputs(), self._robot.event(step.stamp))
        self._robot.carry_out(order, step.stamp)
        self._note(now, step)

    def _skip_idle_time(self, until: float) -> None:
        if self._robot.is_moving:
            return
        now, due = self.now, [until, self._service.wakes_at(self.now)]
        due += [each.stamp for each in self._furniture[:1] if each.stamp > now]
        if min(due) - now >= SHORTEST_IDLE and self._episode.idle(min(due) - self._origin):
            self.record.idle_seconds += self.now - now

    def _move_furniture(self, now: float) -> None:
        """Move furniture that is due; people do so only where the robot is not near."""
        scene, robot = self._episode.simulation.scene, self._robot.inputs().pose
        while self._furniture and self._furniture[0].stamp <= now:
            move = self._furniture[0]
            if robot.distance_to(move.pose) < FURNITURE_CLEARANCE:
                return
            self._furniture.pop(0)
            height = float(scene.models.state(move.model).pose[2, 3])
            scene.set_model_state(move.model, at_rest(from_pose2(move.pose, z=height)))

    def _note(self, now: float, step: StepResult) -> None:
        record, activity = self.record, self._service.activity(now)
        if not record.activities or record.activities[-1][1] != activity:
            record.activities.append((now, activity))
        if not record.track or now - record.track[-1][0] >= RECORD_SECONDS - 1e-6:
            pose = step.base_in_world
            charge = math.nan if step.power is None else step.power.charge
            record.track.append((now, pose.x, pose.y, pose.yaw, charge))
