"""A day of service in the simulator, in one process: requests, idle time skipped."""

import math
from dataclasses import dataclass, field
from typing import List, Optional, Sequence, Tuple

from headless_mission.observers import ContactObserver
from planar import Pose2
from service.day.day_run import DayRecord, RecordedService, Store
from service.day.episode_robot import EpisodeRobot
from service.idle import idle_until
from service.request_service import RequestService
from service.requests.timed_requests import TimedRequest
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult
from sim_bridge.config import LATENCY
from sim_bridge.faults import FaultInjector

# Time between two records of pose and charge [s].
RECORD_SECONDS = 1.0


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

    def note_activity(self, now: float, text: str) -> None:
        """Note what the robot does at a Unix time [s], if that has changed."""
        if not self.activities or self.activities[-1][1] != text:
            self.activities.append((now, text))

    def note_pose(self, now: float, pose: Pose2, charge: Optional[float]) -> None:
        """Note the true pose and the charge, 0 to 1, at a Unix time [s], once a second."""
        if not self.track or now - self.track[-1][0] >= RECORD_SECONDS - 1e-6:
            self.track.append((now, pose.x, pose.y, pose.yaw, math.nan if charge is None else charge))


class SimulatedDay(EpisodeHooks):
    """Runs a service with a simulated robot.

    Args:
        simulation: The simulation, at time 0.
        robot: The robot in it.
        service: The service.
        start: Unix time of the simulation's time 0 [s].
        requests: Requests in the order of their stamps.
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
        faults: Optional[FaultInjector] = None,
        store: Store = lambda changes, number: None,
    ):
        self.record = SimulatedDayRecord()
        self._service = RecordedService(service, requests, self.record, store)
        self._robot, self._origin = robot, start
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
        if step.power is not None and step.power.is_empty and record.empty_at is None:
            record.empty_at = now
        order = self._service.advance(now, self._robot.inputs(), self._robot.event(step.stamp))
        self._robot.carry_out(order, step.stamp)
        record.note_activity(now, self._service.activity(now))
        record.note_pose(now, step.base_in_world, None if step.power is None else step.power.charge)

    def _skip_idle_time(self, until: float) -> None:
        now = self.now
        end = idle_until(now, self._robot.is_moving, until, self._service.wakes_at(now))
        if end > now and self._episode.idle(end - self._origin):
            self.record.idle_seconds += self.now - now
