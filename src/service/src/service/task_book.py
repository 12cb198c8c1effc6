"""Open tasks, series and objects, and what has changed since the journal was written."""

from dataclasses import dataclass, field, replace
from typing import Any, Dict, List, Mapping, Optional, Tuple

from planar import Pose2
from service.errors import UnknownTaskError
from service.task import ObjectState, Series, ServiceTask


@dataclass(frozen=True)
class JournalEntry:
    """Something that happened.

    Attributes:
        stamp: Unix time [s].
        kind: accepted, started, step, interrupted, ended, robot, clock ...
        task: Id of the task it concerns; empty for none.
        text: Explanation for people.
    """

    stamp: float
    kind: str
    task: str
    text: str


@dataclass(frozen=True)
class RobotRecord:
    """What is known of the robot when the service starts again.

    Attributes:
        stamp: Unix time [s].
        pose: Estimated pose in the map.
        is_docked: Whether it is in the dock.
    """

    stamp: float
    pose: Pose2
    is_docked: bool = False


@dataclass
class Changes:
    """What the journal has to store, in one transaction.

    Attributes:
        tasks: Tasks that are new or have changed, by id.
        objects: Objects whose state has changed.
        series: Series that are new or have changed; None: the series has ended.
        log: What happened.
        robot: State of the robot, if it is to be stored.
    """

    tasks: Dict[str, ServiceTask] = field(default_factory=dict)
    objects: Dict[str, ObjectState] = field(default_factory=dict)
    series: Dict[str, Optional[Series]] = field(default_factory=dict)
    log: List[JournalEntry] = field(default_factory=list)
    robot: Optional[RobotRecord] = None

    def __bool__(self) -> bool:
        return bool(self.tasks or self.objects or self.series or self.log or self.robot)


@dataclass(frozen=True)
class Snapshot:
    """What a journal holds of an interrupted service.

    Attributes:
        tasks: Open tasks.
        objects: Objects by name.
        series: Series.
        robot: The robot when the service was last running; None if that was never stored.
        next_number: Number of the next task.
        latest: Latest Unix time in the journal [s]; 0 if it is empty.
    """

    tasks: Tuple[ServiceTask, ...] = ()
    objects: Mapping[str, ObjectState] = field(default_factory=dict)
    series: Tuple[Series, ...] = ()
    robot: Optional[RobotRecord] = None
    next_number: int = 1
    latest: float = 0.0


class TaskBook:
    """State of the service that survives it.

    Args:
        snapshot: State to continue from.

    Attributes:
        tasks: Open tasks by id, in the order of their acceptance.
        objects: Objects by name.
        series: Series by id.
        next_number: Number of the next task.
    """

    def __init__(self, snapshot: Snapshot = Snapshot()):
        self.tasks: Dict[str, ServiceTask] = {task.id: task for task in snapshot.tasks}
        self.objects: Dict[str, ObjectState] = dict(snapshot.objects)
        self.series: Dict[str, Series] = {each.id: each for each in snapshot.series}
        self.next_number = snapshot.next_number
        self._changes = Changes()

    def take_changes(self) -> Changes:
        """Return what has changed since the last call."""
        changes, self._changes = self._changes, Changes()
        return changes

    def new_id(self) -> str:
        """Return the id of the next task."""
        self.next_number += 1
        return str(self.next_number - 1)

    def task(self, task_id: str) -> ServiceTask:
        """Return an open task.

        Raises:
            UnknownTaskError: If there is none of that id.
        """
        if task_id not in self.tasks:
            raise UnknownTaskError(f"there is no open task {task_id}")
        return self.tasks[task_id]

    def put(self, task: ServiceTask) -> ServiceTask:
        """Store a task; one that has ended is no longer open."""
        self._changes.tasks[task.id] = task
        if task.is_open:
            self.tasks[task.id] = task
        else:
            self.tasks.pop(task.id, None)
        return task

    def update(self, task_id: str, **values: Any) -> ServiceTask:
        """Change attributes of an open task."""
        return self.put(replace(self.task(task_id), **values))

    def estimate(self, task_id: str, end: Optional[float]) -> None:
        """Note the planned end of a task, which is not journaled."""
        if task_id in self.tasks:
            self.tasks[task_id] = replace(self.tasks[task_id], estimate=end)

    def put_object(self, name: str, state: ObjectState) -> None:
        """Store where an object is."""
        self.objects[name] = self._changes.objects[name] = state

    def put_series(self, series: Series) -> None:
        """Store a series."""
        self.series[series.id] = self._changes.series[series.id] = series

    def end_series(self, series_id: str) -> None:
        """End a series."""
        del self.series[series_id]
        self._changes.series[series_id] = None

    def put_robot(self, record: RobotRecord) -> None:
        """Store the state of the robot."""
        self._changes.robot = record

    def log(self, stamp: float, kind: str, text: str, task: str = "") -> None:
        """Store what happened."""
        self._changes.log.append(JournalEntry(stamp, kind, task, text))

    @property
    def carrying_task(self) -> Optional[ServiceTask]:
        """Task whose object is on the robot; None if it carries nothing."""
        return next((task for task in self.tasks.values() if task.is_carrying), None)

    def object_after_queue(self, name: str) -> Optional[str]:
        """Return the place of an object after all open tasks; None if no open task moves it."""
        tasks = (task for task in self.tasks.values() if task.request.object_name == name)
        ends = [getattr(task.request.description, "destination", None) for task in tasks]
        return next((end for end in reversed(ends) if end is not None), None)
