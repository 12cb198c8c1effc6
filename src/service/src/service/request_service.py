"""The service: requests in, orders to the robot out."""

import math
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional

from pick_objects import SearchArea
from planar import Pose2
from planar.elapsed_time import ElapsedTime
from planar.maps.places import NamedPlace
from service.config import ServiceSettings
from service.errors import JournalError
from service.execution.activities import DockingActivity
from service.execution.executor import TaskExecutor
from service.execution.robot import RobotEvent, RobotInputs, RobotOrder
from service.plan.job import CHARGE
from service.plan.planner import Planner
from service.plan.rollout import PlanningModel
from service.plan.scheduler import QueueScheduler
from service.requests.admission import Accepted, Admission, FindEnded
from service.requests.calendar_times import clock_text
from service.requests.parser import Knowledge
from service.requests.repetitions import Repetitions
from service.requests.steps import Drive, SetDown
from service.task import ServiceTask
from service.task_book import Changes, RobotRecord, Snapshot, TaskBook

# Time between two records of the robot's pose, and by which the clock may go back unnoticed [s].
ROBOT_RECORD_SECONDS, CLOCK_TOLERANCE = 30.0, 2.0
# Change of the charge after which the queue is planned again, share of the capacity.
CHARGE_STEP = 0.02


@dataclass(frozen=True)
class Site:
    """Where the service works.

    Attributes:
        places: Places by name.
        model: Travel times, battery and dock.
        known: What requests may refer to.
        area: Where objects can be searched; None if there is no semantic map.
    """

    places: Mapping[str, NamedPlace]
    model: PlanningModel
    known: Knowledge = field(default_factory=lambda: Knowledge(()))
    area: Optional[SearchArea] = None


class RequestService:
    """Accepts requests, plans them, and carries them out; it continues from what a journal holds.

    After each call the caller stores ``take_changes()`` in the journal, then acts on orders and answers: what
    the robot does and what clients receive is in the journal before.

    Args:
        site: Places, travel times, battery.
        settings: Durations, patience, bounds.
        snapshot: State to continue from.
        planner: Decides on the order; None: by deadlines, priorities and travel.
        find_ended: Looks up tasks that have ended.

    Attributes:
        book: Open tasks, series, objects.
        executor: What the robot does.
        scheduler: The plan.

    Raises:
        JournalError: If places of open requests are not known here.
    """

    def __init__(
        self,
        site: Site,
        settings: ServiceSettings = ServiceSettings(),
        snapshot: Snapshot = Snapshot(),
        planner: Optional[Planner] = None,
        find_ended: FindEnded = lambda task_id: None,
    ):
        _check_places(snapshot, site.places)
        self._site, self._settings = site, settings
        self.book = TaskBook(snapshot)
        self.executor = TaskExecutor(self.book, site.places, settings, site.area)
        self.scheduler = QueueScheduler(self.book, site.places, site.model, settings, planner)
        self._repetitions = Repetitions(self.book, site.known.zone)
        self._admission = Admission(
            self.book, site.places, site.known, self._repetitions, settings.max_open, find_ended
        )
        self._elapsed, self._latest = ElapsedTime(), snapshot.latest
        self._planned_at, self._planned_charge = -math.inf, 0.0
        self._recorded_at, self._idle_since = -math.inf, 0.0
        self._pending: List[RobotOrder] = []
        self._is_low = False
        self._robot = RobotInputs(Pose2() if snapshot.robot is None else snapshot.robot.pose)

    def take_changes(self) -> Changes:
        """Return what the journal has to store since the last call."""
        return self.book.take_changes()

    def submit(self, document: Any, now: float) -> Accepted:
        """Accept a request; see ``Admission.submit``. ``plan`` notes when it is planned to end."""
        accepted = self._admission.submit(document, now)
        self._planned_at = -math.inf
        return accepted

    def find(self, task_id: str) -> ServiceTask:
        """Return a task that is open or has ended. Raises UnknownTaskError."""
        return self._admission.find(task_id)

    def cancel(self, task_id: str, now: float) -> None:
        """Cancel a task or a series; an object on the robot is set down where it stands.

        Raises:
            UnknownTaskError: If there is none of that id.
            TaskEndedError: If it has ended.
        """
        if task_id in self.book.series:
            ids = self._admission.cancel_series(task_id)
        else:
            self._admission.check_open(task_id)
            ids = [task_id]
        for each in ids:
            order = self.executor.cancel(each, now, self._robot)
            self._pending += [] if order is None else [order]
        self._planned_at = -math.inf

    def plan(self, now: float) -> None:
        """Plan again if something has changed; tasks that will be late are logged."""
        if now - self._planned_at < self._settings.replan_seconds and now >= self._planned_at:
            charge = self._robot.charge
            if charge is None or abs(charge - self._planned_charge) < CHARGE_STEP:
                return
        self._planned_at, self._planned_charge = now, self._robot.charge or 0.0
        for task in self.scheduler.update(now, self._robot, self.executor.current):
            end = clock_text(task.estimate or now, self._site.known.zone)
            self.book.log(now, "late", f"cannot be done in time: planned to end at {end}", task.id)

    def advance(
        self, now: float, robot: RobotInputs, event: Optional[RobotEvent] = None
    ) -> Optional[RobotOrder]:
        """Advance to the current time.

        Args:
            now: Unix time [s].
            robot: State of the robot.
            event: What happened to the last order, if there is news.

        Returns:
            The next order; None while nothing changes.
        """
        self._note_clock(now)
        self._note_battery(now, robot)
        elapsed, self._robot = self._elapsed.update(now), robot
        if self._pending:
            return self._pending.pop(0)
        if self._repetitions.update(now):
            self._planned_at = -math.inf
        before = self._state_of_work()
        order = self.executor.advance(now, elapsed, robot, event)
        if self._state_of_work() != before:
            self._planned_at = -math.inf
        self.plan(now)
        if order is None:
            order = self._follow_plan(now, elapsed)
        self._record_robot(now)
        return order

    def wakes_at(self, now: float) -> float:
        """Return the Unix time at which ``advance`` has to be called although no event comes [s]."""
        elapsed = self._elapsed.update(now)
        times = [self._planned_at + self._settings.replan_seconds if self.book.tasks else math.inf]
        activity = self.executor.activity
        if activity is not None and activity.wakes_at is not None:
            times.append(now + activity.wakes_at - elapsed)
        elif activity is None and not self._robot.is_docked:
            times.append(self._idle_since + now - elapsed + self._settings.park_seconds)
        times += [entry.start for entry in self.scheduler.plan.entries[:1]]
        due = self._repetitions.next_due()
        return min([each for each in (*times, due or math.inf) if each > now], default=math.inf)

    def state(self, now: float) -> Dict[str, Any]:
        """Return what the robot does, for people, as JSON values."""
        activity, robot = self.executor.activity, self._robot
        pose = {"x": round(robot.pose.x, 3), "y": round(robot.pose.y, 3), "yaw": round(robot.pose.yaw, 3)}
        carrying = self.book.carrying_task
        idle = "charging" if robot.is_docked else "idle"
        return {
            "unix_millis_time": round(1000.0 * now),
            "activity": idle if activity is None else activity.text,
            "task": self.executor.current or None,
            "carrying": None if carrying is None else carrying.request.object_name,
            "pose": pose,
            "charge": None if robot.charge is None else round(robot.charge, 4),
            "is_docked": robot.is_docked,
            "open": len(self.book.tasks),
            "series": sorted(self.book.series),
            "objects": {
                name: state.place or ("on the robot" if state.carried_by else "left on the way")
                for name, state in sorted(self.book.objects.items())
            },
        }

    def _state_of_work(self) -> Any:
        current = self.book.tasks.get(self.executor.current)
        return self.executor.current, None if current is None else current.step, self.executor.activity

    def _follow_plan(self, now: float, elapsed: float) -> Optional[RobotOrder]:
        """Start, interrupt or park as planned."""
        executor, first = self.executor, self.scheduler.plan.first
        if executor.activity is not None:
            self._idle_since = elapsed
        if first is None or first.start > now + 1e-3:
            return None if executor.activity is not None else self._park(now, elapsed)
        is_docking = isinstance(executor.activity, DockingActivity) and not executor.current
        if first.id == executor.current or not executor.is_interruptible:
            return None
        if first.id == CHARGE:
            if is_docking or self._robot.is_docked:
                return None
            return self._interrupt(now, "to charge") or executor.begin_docking(now, elapsed, self._robot)
        stop = self._interrupt(now, f"task {first.id} is more urgent")
        return stop or executor.begin(first.id, now, elapsed, self._robot)

    def _interrupt(self, now: float, reason: str) -> Optional[RobotOrder]:
        """Stop what the robot does; the plan is followed at the next call."""
        return None if self.executor.activity is None else self.executor.suspend(now, reason)

    def _park(self, now: float, elapsed: float) -> Optional[RobotOrder]:
        """Wait in the dock if nothing is due for a while."""
        around, robot, first = self._site.model, self._robot, self.scheduler.plan.first
        if around.dock is None or robot.is_docked or robot.charge is None:
            return None
        home = around.travel.seconds(robot.pose, around.dock) + around.docking_seconds
        gap = math.inf if first is None else first.start - now
        is_long_idle = elapsed - self._idle_since >= self._settings.park_seconds
        needs_charge = robot.charge < around.energy.idle_charge and elapsed - self._idle_since >= 5.0
        if gap < 2.0 * home + 60.0 or not (is_long_idle or needs_charge):
            return None
        return self.executor.begin_docking(now, elapsed, robot)

    def _note_clock(self, now: float) -> None:
        if now < self._latest - CLOCK_TOLERANCE:
            self.book.log(now, "clock", f"the clock went back by {self._latest - now:.0f} s")
            self._planned_at = -math.inf
        self._latest = now

    def _note_battery(self, now: float, robot: RobotInputs) -> None:
        """Note that the charge is low where there is no dock."""
        around, charge, was_low = self._site.model, robot.charge, self._is_low
        self._is_low = around.dock is None and charge is not None and charge < around.energy.reserve
        if self._is_low and not was_low and not robot.is_docked:
            text = (
                f"the charge is {100.0 * (charge or 0.0):.0f} %, and there is no dock: place one with --dock"
            )
            self.book.log(now, "battery", text)

    def _record_robot(self, now: float) -> None:
        """Note the robot's pose now and then, and while it works."""
        is_working = self.executor.activity is not None
        if (
            0.0
            <= now - self._recorded_at
            < (ROBOT_RECORD_SECONDS if is_working else 20 * ROBOT_RECORD_SECONDS)
        ):
            return
        self._recorded_at = now
        self.book.put_robot(RobotRecord(now, self._robot.pose, self._robot.is_docked))


def _check_places(snapshot: Snapshot, known: Mapping[str, NamedPlace]) -> None:
    """Refuse to go on where places of open requests are missing; they would be lost."""
    requests = [task.request for task in snapshot.tasks] + [series.request for series in snapshot.series]
    steps = [step for request in requests for step in request.description.steps()]
    missing = {step.place for step in steps if isinstance(step, (Drive, SetDown))}.difference(known)
    if missing:
        names = ", ".join(f'"{name}"' for name in sorted(missing))
        raise JournalError(
            f"open requests are for {names}, not known here (known: {', '.join(known)}); start with the "
            "same --mission or zones as before, or with another --state folder"
        )
