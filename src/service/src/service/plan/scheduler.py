"""From tasks to a plan, and from a plan to what the robot does next."""

from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pick_objects.driving_time import SEARCH_SECONDS
from planar import Pose2
from planar.maps.places import NamedPlace
from service.config import ServiceSettings
from service.execution.robot import RobotInputs
from service.plan.job import CHARGE, PlannedJob, PlanStart, QueuePlan, Stop
from service.plan.planner import DeadlinePlanner, Planner
from service.plan.rollout import PlanningModel, roll_out
from service.requests.steps import Drive, DriveToObject, EnterDock, FindObject, Pause, PickUp, SetDown, Step
from service.task import ServiceTask
from service.task_book import TaskBook

# Change of a planned end that is not noted [s].
SAME_SECONDS = 1.0


class QueueScheduler:
    """Plans the open tasks.

    Args:
        book: Tasks and objects.
        places: Places by name.
        surroundings: Travel times, battery and dock.
        settings: Durations.
        planner: Decides on the order.

    Attributes:
        plan: The latest plan.
    """

    def __init__(
        self,
        book: TaskBook,
        places: Mapping[str, NamedPlace],
        surroundings: PlanningModel,
        settings: ServiceSettings,
        planner: Optional[Planner] = None,
    ):
        self._book, self._places, self._around, self._settings = book, places, surroundings, settings
        self._planner: Planner = planner or DeadlinePlanner()
        self.plan = QueuePlan()
        self._cache: Dict[str, Tuple[ServiceTask, PlannedJob]] = {}

    def update(self, now: float, robot: RobotInputs, current: str) -> List[ServiceTask]:
        """Plan again.

        Args:
            now: Unix time [s].
            robot: State of the robot.
            current: Id of the task under way; empty if there is none.

        Returns:
            Tasks that are now planned to end after their deadline, and were not before.
        """
        carrying = self._book.carrying_task
        charge = robot.charge if self._around.dock is not None else None
        start = PlanStart(
            now, robot.pose, charge, robot.is_docked, current, "" if carrying is None else carrying.id
        )
        jobs = self._jobs()
        self.plan = self._planner.plan(jobs, self._around, start)
        if current and isinstance(self._planner, DeadlinePlanner):
            self.plan = self._keep_current(jobs, start)
        return self._note_estimates()

    def _keep_current(self, jobs: Sequence[PlannedJob], start: PlanStart) -> QueuePlan:
        """Return the plan that goes on with the current task, unless the other one is clearly better."""
        first = next((entry for entry in self.plan.entries if entry.id != CHARGE), None)
        by_id = {job.id: job for job in jobs}
        if first is None or first.id == start.current or start.current not in by_id:
            return self.plan
        if by_id[first.id].priority > by_id[start.current].priority and first.start <= start.now:
            return self.plan
        rest = [by_id[entry.id] for entry in self.plan.entries if entry.id in by_id]
        order = [by_id[start.current], *(job for job in rest if job.id != start.current)]
        kept = roll_out(order, self._around, start, fills_up=False)
        return self.plan if self.plan.cost[0] < kept.cost[0] else kept

    def _note_estimates(self) -> List[ServiceTask]:
        ends = {entry.id: entry.end for entry in self.plan.entries}
        late = []
        for task in list(self._book.tasks.values()):
            end = ends.get(task.id)
            if end is not None and task.estimate is not None and abs(end - task.estimate) < SAME_SECONDS:
                continue
            self._book.estimate(task.id, end)
            if self._book.task(task.id).is_late and not task.is_late:
                late.append(self._book.task(task.id))
        return late

    def _jobs(self) -> List[PlannedJob]:
        latest: Dict[str, str] = {}
        carrying = self._book.carrying_task
        if carrying is not None:
            latest["*"] = carrying.id
        jobs = []
        for task in self._book.tasks.values():
            name, after = task.request.object_name, []
            if name:
                after = [latest[key] for key in (name, "*") if key in latest and latest[key] != task.id]
                latest[name] = task.id
            jobs.append(self._job(task, (*after, *task.request.after)))
        if len(self._cache) > 2 * len(jobs) + 100:
            self._cache = {job.id: self._cache[job.id] for job in jobs}
        return jobs

    def _job(self, task: ServiceTask, after: Tuple[str, ...]) -> PlannedJob:
        """Return the job of a task; that of an unchanged task without object is not made again."""
        cached = self._cache.get(task.id)
        if cached is not None and cached[0] is task and not task.request.object_name:
            return cached[1]
        job = self._new_job(task, after)
        self._cache[task.id] = (task, job)
        return job

    def _new_job(self, task: ServiceTask, after: Tuple[str, ...]) -> PlannedJob:
        request, steps = task.request, task.request.description.steps()
        return PlannedJob(
            task.id,
            self._stops(task, steps),
            request.release,
            request.deadline,
            request.priority,
            after,
            isinstance(steps[-1], EnterDock),
            not request.object_name,
        )

    def _stops(self, task: ServiceTask, steps: Sequence[Step]) -> Tuple[Stop, ...]:
        """Remaining drives and times of standing; standing belongs to the place of the drive before."""
        first = task.step
        while 0 < first < len(steps) and not isinstance(steps[first], (Drive, DriveToObject)):
            first -= 1
        stops: List[Stop] = []
        for step in steps[first:]:
            pose, seconds = self._pose_of(step), self._seconds_of(step)
            if pose is not None or not stops:
                stops.append(Stop(pose, seconds))
            else:
                stops[-1] = Stop(stops[-1].pose, stops[-1].seconds + seconds)
        return tuple(stop for stop in stops if stop.pose is not None or stop.seconds > 0.0)

    def _pose_of(self, step: Step) -> Optional[Pose2]:
        if isinstance(step, Drive):
            return self._places[step.place].pose
        if isinstance(step, DriveToObject):
            place = self._book.object_after_queue(step.object_name)  # where it is once it is due
            state = self._book.objects.get(step.object_name)
            if state is not None and state.place in self._places:
                place = state.place
            return self._places[place].pose if place else None if state is None else state.pose
        return None

    def _seconds_of(self, step: Step) -> float:
        if isinstance(step, PickUp):
            return self._settings.pickup_seconds
        if isinstance(step, SetDown):
            return self._settings.dropoff_seconds
        if isinstance(step, (FindObject, DriveToObject)) and self._is_searched(step.object_name):
            return SEARCH_SECONDS
        return step.seconds if isinstance(step, Pause) else 0.0

    def _is_searched(self, name: str) -> bool:
        state = self._book.objects.get(name)
        return self._book.object_after_queue(name) is None and (state is None or not state.is_located)
