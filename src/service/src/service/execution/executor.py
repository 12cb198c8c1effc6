"""Execution of one task at a time, step by step; each completed step is noted in the book."""

from typing import Dict, Mapping, Optional

from pick_objects import DriveToPlace, SearchArea
from pick_objects.search import ObjectFound, ObjectSearch
from planar import Pose2
from planar.maps.places import NamedPlace
from service.config import ServiceSettings
from service.execution.activities import (
    Activity,
    ActivityDisplaced,
    ActivityDone,
    ActivityFailed,
    DockingActivity,
    Driving,
    Outcome,
    Searching,
    Standing,
    UndockingActivity,
)
from service.execution.robot import RobotEvent, RobotInputs, RobotOrder, StopRobot
from service.requests.request import Deliver
from service.requests.steps import (
    DRIVES,
    Drive,
    DriveToObject,
    EnterDock,
    FindObject,
    Pause,
    PickUp,
    SetDown,
    Step,
)
from service.task import ObjectState, ServiceTask, TaskStatus
from service.task_book import TaskBook


class TaskExecutor:
    """Carries out the current task, or drives into the dock.

    Args:
        book: Tasks and objects, updated in place.
        places: Places by name.
        settings: Durations and patience.
        area: Where objects can be searched; None if there is no semantic map.

    Attributes:
        current: Id of the task under way; empty if there is none.
        activity: What the robot does; None if it stands idle.
    """

    def __init__(
        self,
        book: TaskBook,
        places: Mapping[str, NamedPlace],
        settings: ServiceSettings,
        area: Optional[SearchArea] = None,
    ):
        self._book, self._places, self._settings, self._area = book, places, settings, area
        self.current = ""
        self.activity: Optional[Activity] = None
        self._is_returning, self._displacements = False, 0
        self._robot = RobotInputs(Pose2())

    @property
    def is_interruptible(self) -> bool:
        """Whether another task may start now."""
        return self.activity is None or self.activity.is_interruptible

    def begin(self, task_id: str, now: float, elapsed: float, robot: RobotInputs) -> Optional[RobotOrder]:
        """Start a task, or go on with one that was interrupted.

        Args:
            task_id: Id of the task.
            now: Unix time [s].
            elapsed: Elapsed time [s].
            robot: State of the robot.
        """
        self._robot, self.current, self._displacements = robot, task_id, 0
        task = self._book.task(task_id)
        started_at = now if task.started_at is None else task.started_at
        verb = "started" if task.started_at is None else "resumed"
        self._book.update(task_id, status=TaskStatus.UNDERWAY, started_at=started_at, reason="")
        self._book.log(now, verb, verb, task_id)
        self._put_object_back(task)
        return self._begin_step(now, elapsed, may_return=True)

    def _put_object_back(self, task: ServiceTask) -> None:
        """Note the object of a repetition at its source: people have brought it there since the last one."""
        description = task.request.description
        if task.series and task.step == 0 and isinstance(description, Deliver):
            pose = self._places[description.source].pose
            self._book.put_object(description.object_name, ObjectState(description.source, pose))

    def begin_docking(self, now: float, elapsed: float, robot: RobotInputs) -> Optional[RobotOrder]:
        """Drive into the dock without a task."""
        self._robot = robot
        self._book.log(now, "robot", "drives to the dock")
        return self._start(DockingActivity(self._settings), elapsed)

    def suspend(self, now: float, reason: str) -> Optional[RobotOrder]:
        """Interrupt the current task or activity; the task keeps its completed steps."""
        if self.current in self._book.tasks:
            task = self._book.task(self.current)
            self._book.update(
                task.id, status=TaskStatus.QUEUED, interruptions=task.interruptions + 1, reason=reason
            )
            self._book.log(now, "interrupted", reason, task.id)
        return self._stop()

    def cancel(self, task_id: str, now: float, robot: RobotInputs) -> Optional[RobotOrder]:
        """End a task; an object that is carried for it is set down where the robot stands."""
        self._robot = robot
        self._end(self._book.task(task_id), TaskStatus.CANCELED, now, "canceled")
        return self._stop() if task_id == self.current else None

    def advance(
        self, now: float, elapsed: float, robot: RobotInputs, event: Optional[RobotEvent]
    ) -> Optional[RobotOrder]:
        """Advance the current activity; return the next order, None while nothing changes."""
        self._robot = robot
        if self.activity is None:
            return None
        outcome: Outcome = self.activity.advance(elapsed, event)
        if isinstance(outcome, ActivityDone):
            return self._on_done(now, elapsed)
        if isinstance(outcome, ActivityFailed):
            return self._on_failed(now, outcome.reason)
        if isinstance(outcome, ActivityDisplaced):
            return self._on_displaced(now, elapsed)
        if isinstance(outcome, DriveToPlace) and self.current:
            self._book.update(self.current, attempts=self._book.task(self.current).attempts + 1)
        return outcome

    def _on_done(self, now: float, elapsed: float) -> Optional[RobotOrder]:
        activity = self.activity
        if isinstance(activity, UndockingActivity):
            self.activity = activity.following
            return activity.following.start(elapsed)
        if not self.current:
            self._book.log(now, "robot", "is in the dock")
            self.activity = None
            return None
        if isinstance(activity, Searching) and activity.found is not None:
            self._note_found(now, activity.found)
            return self._begin_step(now, elapsed, may_return=False)
        if self._is_returning:
            return self._begin_step(now, elapsed, may_return=False)
        self._complete_step(now)
        return self._begin_step(now, elapsed, may_return=False)

    def _note_found(self, now: float, found: ObjectFound) -> None:
        """Note where an object is, and from where it can be picked up."""
        name = found.place.name
        self._book.put_object(name, ObjectState(found.furniture or None, found.place.pose))
        self._book.log(now, "step", f"{name} is {found.where}", self.current)

    def _on_failed(self, now: float, reason: str) -> Optional[RobotOrder]:
        if self.current:
            self._end(self._book.task(self.current), TaskStatus.FAILED, now, reason)
        else:
            self._book.log(now, "robot", reason)
        return self._stop()

    def _on_displaced(self, now: float, elapsed: float) -> Optional[RobotOrder]:
        """Return to the place, at most as often as places are tried."""
        self._displacements += 1
        if self._displacements >= self._settings.attempts:
            reason = f"the robot was moved away, or its pose became uncertain, {self._displacements} times"
            return self._on_failed(now, reason)
        return self._begin_step(now, elapsed, may_return=True)

    def _begin_step(self, now: float, elapsed: float, may_return: bool) -> Optional[RobotOrder]:
        """Start the next step; ``may_return``: the robot may have left the place of the last one."""
        task = self._book.task(self.current)
        steps = task.request.description.steps()
        if task.step >= len(steps):
            self._end(task, TaskStatus.COMPLETED, now)
            self._stop_task()
            return None
        step = steps[task.step]
        if isinstance(step, FindObject) and self._is_located(step.object_name):
            self._complete_step(now)
            return self._begin_step(now, elapsed, may_return=False)
        problem = problem_of(task, step, self._book.objects, self._area)
        if problem:
            return self._on_failed(now, problem)
        self._is_returning = may_return and not isinstance(step, DRIVES)
        last = next((each for each in reversed(steps[: task.step]) if isinstance(each, DRIVES)), None)
        self._is_returning = self._is_returning and last is not None
        activity = self._activity_of(task, last if self._is_returning and last is not None else step, now)
        order = self._start(activity, elapsed)
        if isinstance(order, DriveToPlace):
            self._book.update(task.id, attempts=task.attempts + 1)
        return order

    def _start(self, activity: Activity, elapsed: float) -> Optional[RobotOrder]:
        if isinstance(activity, Driving) and self._robot.is_docked:
            activity = UndockingActivity(activity, self._settings)
        self.activity = activity
        return activity.start(elapsed)

    def _activity_of(self, task: ServiceTask, step: Step, now: float) -> Activity:
        settings = self._settings
        if isinstance(step, Drive):
            return Driving(self._places[step.place], settings)
        if isinstance(step, (FindObject, DriveToObject)) and not self._is_located(step.object_name):
            assert self._area is not None  # see problem_of
            search = ObjectSearch(self._area, step.object_name)
            return Searching(search, settings, lambda: self._robot.pose)
        if isinstance(step, DriveToObject):
            return Driving(self.place_of(step.object_name), settings)
        if isinstance(step, PickUp):
            return Standing(f"picking up {step.object_name}", settings.pickup_seconds)
        if isinstance(step, SetDown):
            return Standing(f"setting down {step.object_name}", settings.dropoff_seconds)
        if isinstance(step, Pause):
            return self._pause(task, step, now)
        return DockingActivity(settings, settings.attempts)

    def _pause(self, task: ServiceTask, step: Pause, now: float) -> Activity:
        """A pause goes on after a restart: its begin is noted."""
        since = now if task.step_started_at is None else task.step_started_at
        self._book.update(task.id, step_started_at=since)
        left = min(step.seconds, max(0.0, since + step.seconds - now))
        return Standing("waiting", left, is_interruptible=True)

    def _is_located(self, name: str) -> bool:
        return name in self._book.objects and self._book.objects[name].is_located

    def place_of(self, object_name: str) -> NamedPlace:
        """Return where to pick up an object: its place, or the pose at which the robot left it."""
        state = self._book.objects[object_name]
        if state.place is not None and state.place in self._places:
            return self._places[state.place]
        return NamedPlace(object_name, state.pose or Pose2())

    def _complete_step(self, now: float) -> None:
        task = self._book.task(self.current)
        step = task.request.description.steps()[task.step]
        if isinstance(step, PickUp):
            self._book.put_object(step.object_name, ObjectState(None, self._robot.pose, task.id))
        elif isinstance(step, SetDown):
            self._book.put_object(step.object_name, ObjectState(step.place, self._places[step.place].pose))
        self._book.update(task.id, step=task.step + 1, step_started_at=None)
        self._book.log(now, "step", text_of(step), task.id)
        self._displacements = 0

    def _end(self, task: ServiceTask, status: TaskStatus, now: float, reason: str = "") -> None:
        name = task.request.object_name
        if task.is_carrying and status is not TaskStatus.COMPLETED:
            self._book.put_object(name, ObjectState(None, self._robot.pose))
        ended = self._book.put(task.ended(status, now, reason))
        late = " after its deadline" if ended.is_late and status is TaskStatus.COMPLETED else ""
        self._book.log(now, "ended", f"{status.value}{late}{': ' if reason else ''}{reason}", task.id)
        if status is not TaskStatus.COMPLETED:
            for other in list(self._book.tasks.values()):
                if task.id in other.request.after:
                    self._end(other, TaskStatus.FAILED, now, f"task {task.id} was not done")

    def _stop_task(self) -> None:
        self.current, self.activity, self._is_returning = "", None, False

    def _stop(self) -> Optional[RobotOrder]:
        was_active = self.activity is not None
        self._stop_task()
        return StopRobot() if was_active else None


def problem_of(
    task: ServiceTask, step: Step, objects: Mapping[str, ObjectState], area: Optional[SearchArea]
) -> str:
    """Return why a step cannot be done, as a sentence; empty if it can.

    Args:
        task: Task of the step.
        step: The step.
        objects: Where objects are known to be.
        area: Where objects can be searched; None if there is no semantic map.
    """
    name = task.request.object_name
    if not name or task.is_carrying:
        return ""
    state = objects.get(name)
    source = getattr(task.request.description, "source", None)
    if state is None or not state.is_located:
        if area is None or not isinstance(step, (FindObject, DriveToObject)):
            return f"it is not known where {name} is"
        return area.semantic_map.problem_with(name)
    if state.carried_by and state.carried_by != task.id:
        return f"{name} is on the robot for task {state.carried_by}"
    if source is not None and state.place != source:
        return f"{name} is not at {source}" + (f" but at {state.place}" if state.place else "")
    return ""


TEXTS: Dict[type, str] = {
    Drive: "at {place}",
    FindObject: "{object_name} found",
    DriveToObject: "at {object_name}",
    PickUp: "{object_name} picked up",
    SetDown: "{object_name} set down at {place}",
    Pause: "waited {seconds:g} s",
    EnterDock: "in the dock",
}


def text_of(step: Step) -> str:
    """Return what was done, for people."""
    return TEXTS[type(step)].format(**vars(step))
