"""Times, charge and costs of one order of jobs."""

from dataclasses import dataclass
from typing import List, Optional, Protocol, Sequence, Tuple

from planar import Pose2
from service.config import EnergySettings
from service.plan.job import CHARGE, PlanEntry, PlannedJob, PlanStart, QueuePlan

HOUR = 3600.0
# Idle time from which on the plan counts on charging [s], beside the drive to the dock and back.
SHORTEST_CHARGE = 120.0
# Margin added to the energy of a job, as drives take longer than planned.
MARGIN = 1.3
# A job is planned to end that much before its deadline, as drives take longer than planned [share, s].
SLACK_SHARE, SLACK_SECONDS = 0.1, 5.0


class TravelTimes(Protocol):
    """Time of drives."""

    def seconds(self, start: Pose2, end: Pose2) -> float:
        """Return the time to drive from one pose in the map to another [s]."""


@dataclass(frozen=True)
class PlanningModel:
    """What does not change with the order.

    Attributes:
        travel: Times of drives.
        energy: Figures of the battery.
        dock: Pose in front of the dock; None without a dock.
        docking_seconds: Time to dock or undock [s].
    """

    travel: TravelTimes
    energy: EnergySettings = EnergySettings()
    dock: Optional[Pose2] = None
    docking_seconds: float = 30.0


class Rollout:
    """Advances a plan job by job.

    Args:
        surroundings: Travel times and battery.
        start: Where the plan starts.
        fills_up: Charge to the full once charging; otherwise only as much as the next job needs.
    """

    def __init__(self, surroundings: PlanningModel, start: PlanStart, fills_up: bool):
        self._around, self._fills_up = surroundings, fills_up
        self._start = self._now = start.now
        self._pose, self._charge = start.pose, start.charge
        self._is_docked, self._current = start.is_docked, start.current
        energy = surroundings.energy
        self._drive = 1.0 / (energy.drive_hours * HOUR)
        self._stand = 1.0 / (energy.stand_hours * HOUR)
        self._rate = 1.0 / (energy.charge_hours * HOUR)
        self.entries: List[PlanEntry] = []
        self._missed = self._delay = 0.0

    def plan(self) -> QueuePlan:
        """Return the plan so far."""
        return QueuePlan(tuple(self.entries), (self._missed, self._delay))

    def add(self, job: PlannedJob) -> None:
        """Append a job, and charging before it if it is needed."""
        if self._charge is not None and self._around.dock is not None:
            self._idle_until(job.release)
            self._charge_for(job)
        start = max(self._now, job.release)
        self._spend((start - self._now) * self._stand if not self._is_docked else 0.0)
        seconds, used, pose = self._work(job)
        self._now, self._pose, self._is_docked = start + seconds, pose, job.is_docking
        self._spend(used)
        is_late = job.deadline is not None and self._now > job.deadline
        if job.deadline is not None and job.deadline > self._start:  # else it is missed in any order
            slack = SLACK_SHARE * seconds + SLACK_SECONDS
            is_tight = self._now + slack > job.deadline
            self._missed += job.weight * (1.0 if is_late else 0.5 if is_tight else 0.0)
        self._delay += job.weight * (self._now - job.release) / (10.0 if is_late else 1.0)
        self.entries.append(PlanEntry(job.id, start, self._now, is_late, self._charge))

    def _work(self, job: PlannedJob) -> Tuple[float, float, Pose2]:
        """Return duration [s], energy and end of a job."""
        around, pose = self._around, self._pose
        seconds = around.docking_seconds if self._is_docked and job.stops and not job.is_docking else 0.0
        used = 0.0
        for stop in job.stops:
            drive = 0.0 if stop.pose is None else around.travel.seconds(pose, stop.pose)
            seconds += drive + stop.seconds
            used += drive * self._drive + stop.seconds * self._stand
            pose = pose if stop.pose is None else stop.pose
        if job.is_docking and around.dock is not None and not self._is_docked:
            drive = around.travel.seconds(pose, around.dock)
            seconds, used, pose = (
                seconds + drive + around.docking_seconds,
                used + drive * self._drive,
                around.dock,
            )
        return seconds, used, pose

    def _home(self, pose: Pose2) -> float:
        """Time of the drive into the dock [s]."""
        assert self._around.dock is not None
        return self._around.travel.seconds(pose, self._around.dock) + self._around.docking_seconds

    def _idle_until(self, release: float) -> None:
        """Charge while nothing is due."""
        assert self._charge is not None
        home = 0.0 if self._is_docked else self._home(self._pose)
        if release - self._now > 2.0 * home + SHORTEST_CHARGE or self._is_docked:
            gained = max(0.0, release - self._now - 2.0 * home) * self._rate
            if gained > 0.0 and not self._is_docked:
                self._spend(home * self._drive)
                self._pose, self._is_docked = self._around.dock or self._pose, True
            self._charge = min(1.0, self._charge + gained)
            self._now = max(self._now, release)

    def _charge_for(self, job: PlannedJob) -> None:
        """Charge before a job after which the charge would not last to return to the dock."""
        assert self._charge is not None and self._around.dock is not None
        energy = self._around.energy
        needed = self._needed(job, self._pose)
        is_filling = self._fills_up and self._is_docked and job.id != self._current
        if self._charge >= needed and not (is_filling and self._charge < energy.full):
            return
        if self._is_docked and self._charge >= energy.full:
            return  # no more can be charged for it
        start, home = self._now, 0.0 if self._is_docked else self._home(self._pose)
        self._spend(home * self._drive)
        self._pose, self._is_docked = self._around.dock, True
        target = energy.full if self._fills_up else min(energy.full, self._needed(job, self._pose))
        seconds = max(0.0, target - self._charge) / self._rate
        self._now += home + seconds
        self._charge = max(self._charge, target)
        self.entries.append(PlanEntry(CHARGE, start, self._now, charge=target))

    def _needed(self, job: PlannedJob, pose: Pose2) -> float:
        """Charge with which a job can be done so that the robot returns with its reserve."""
        before, self._pose = self._pose, pose
        _, used, end = self._work(job)
        self._pose = before
        home = 0.0 if job.is_docking else self._home(end) * self._drive
        return self._around.energy.reserve + MARGIN * (used + home)

    def _spend(self, charge: float) -> None:
        if self._charge is not None:
            self._charge = max(0.0, self._charge - charge)


def roll_out(
    jobs: Sequence[PlannedJob], surroundings: PlanningModel, start: PlanStart, fills_up: bool
) -> QueuePlan:
    """Return the plan that carries out jobs in this order."""
    rollout = Rollout(surroundings, start, fills_up)
    for job in jobs:
        rollout.add(job)
    return rollout.plan()
