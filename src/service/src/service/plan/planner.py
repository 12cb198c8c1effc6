"""Search for the order of the queue: priorities, deadlines, travel and charging."""

from itertools import permutations
from typing import Dict, Iterable, Iterator, List, Optional, Protocol, Sequence, Tuple

from service.plan.job import PlannedJob, PlanStart, QueuePlan
from service.plan.rollout import PlanningModel, roll_out

# Number of jobs for which every order is tried, and whose order is improved; further ones follow by deadline.
MAX_EXACT, WINDOW = 4, 8
# Orders that are tried at most while one is improved.
MAX_TRIALS = 120
# Jobs whose order is compared at all; the less urgent ones of a longer queue follow.
MOST_COMPARED = 40
# A job without deadline is ranked as if it had one that long after its release; a level of priority counts as
# much as this earlier deadline [s].
ASSUMED_SLACK, PRIORITY_SECONDS = 4.0 * 3600.0, 3600.0


class Planner(Protocol):
    """Decides on the order of jobs."""

    def plan(self, jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart) -> QueuePlan:
        """Return a plan that contains each job once."""


class DeadlinePlanner:
    """Minimizes missed deadlines, then delays, each weighted by priority.

    All orders of few jobs are compared; with more, the best of several rules is improved by moving single
    jobs (Or-opt; Or, 1976) until none helps.
    """

    def plan(self, jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart) -> QueuePlan:
        """Return the best plan found."""
        least = self._plan(jobs, around, start, fills_up=False)
        if start.charge is None:
            return least
        full = self._plan(jobs, around, start, fills_up=True)
        return least if least.cost[0] < full.cost[0] else full

    def _plan(
        self, jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart, fills_up: bool
    ) -> QueuePlan:
        best: Optional[QueuePlan] = None
        order: Sequence[PlannedJob] = ()
        ranked = in_valid_order(sorted(jobs, key=urgency))
        for candidate in candidates(ranked[:MOST_COMPARED], around, start):
            plan = roll_out(candidate[:WINDOW], around, start, fills_up)
            if best is None or plan.cost < best.cost:
                best, order = plan, candidate
        if best is None:
            return QueuePlan()
        if len(jobs) > MAX_EXACT:
            order = self._improve(list(order), best, around, start, fills_up)
        return roll_out([*order, *ranked[MOST_COMPARED:]], around, start, fills_up)

    def _improve(
        self,
        order: List[PlannedJob],
        best: QueuePlan,
        around: PlanningModel,
        start: PlanStart,
        fills_up: bool,
    ) -> Sequence[PlannedJob]:
        trials, is_better = 0, True
        while is_better and trials < MAX_TRIALS:
            is_better = False
            for moved in relocations(order):
                trials += 1
                plan = roll_out(moved[:WINDOW], around, start, fills_up)
                if plan.cost < best.cost:
                    best, order, is_better = plan, moved, True
                    break
                if trials >= MAX_TRIALS:
                    break
        return order


class FirstComeFirstServed:
    """Baseline: the order of acceptance, charging below a threshold up to the full.

    Args:
        threshold: Charge below which the robot charges before the next job.
    """

    def __init__(self, threshold: float = 0.3):
        self._threshold = threshold

    def plan(self, jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart) -> QueuePlan:
        """Return the jobs that are due in the given order, the others behind them."""
        ready = sorted(jobs, key=lambda job: (job.id != start.carrying, job.release > start.now))
        ready = [
            *(job for job in ready if job.id == start.current),
            *(j for j in ready if j.id != start.current),
        ]
        is_low = start.charge is not None and start.charge < self._threshold
        return roll_out(ready, around, start, fills_up=is_low or start.is_docked)


def urgency(job: PlannedJob) -> float:
    """Return a key by which the most urgent jobs come first [s]."""
    assumed = job.release + ASSUMED_SLACK
    deadline = assumed if job.deadline is None else min(job.deadline, assumed)
    return deadline - PRIORITY_SECONDS * job.priority


def candidates(
    jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart
) -> Iterator[List[PlannedJob]]:
    """Yield orders that respect what must be done before what."""
    if len(jobs) <= MAX_EXACT:
        yield from (list(order) for order in permutations(jobs) if is_valid(order))
        return
    inf = float("inf")
    yield in_valid_order(sorted(jobs, key=lambda job: (job.release > start.now, job.release)))
    yield in_valid_order(sorted(jobs, key=lambda job: (job.deadline or inf, -job.priority, job.release)))
    yield in_valid_order(
        sorted(jobs, key=lambda job: (-job.priority, job.deadline or inf, job.release)),
    )
    yield in_valid_order(nearest_first(jobs, around, start))


def nearest_first(jobs: Sequence[PlannedJob], around: PlanningModel, start: PlanStart) -> List[PlannedJob]:
    """Return jobs sorted by the time until their first stop is reached or they are due."""

    def ready_at(job: PlannedJob) -> Tuple[float, float]:
        pose = job.stops[0].pose if job.stops else None
        drive = 0.0 if pose is None else around.travel.seconds(start.pose, pose)
        return max(job.release - start.now, drive), job.release

    return sorted(jobs, key=ready_at)


def is_valid(order: Iterable[PlannedJob]) -> bool:
    """Return whether each job comes after those that must be done before."""
    order = list(order)
    present, done = {job.id for job in order}, set()
    for job in order:
        if any(name in present and name not in done for name in job.after):
            return False
        done.add(job.id)
    return True


def in_valid_order(order: Sequence[PlannedJob]) -> List[PlannedJob]:
    """Return the jobs in an order as near to the given one as what must be done before allows."""
    by_id = {job.id: job for job in order}
    done: Dict[str, PlannedJob] = {}
    for job in order:
        waiting = [job]
        while waiting:
            missing = [by_id[name] for name in waiting[-1].after if name in by_id and name not in done]
            if missing:
                waiting += missing
            else:
                ready = waiting.pop()
                done.setdefault(ready.id, ready)
    return list(done.values())


def relocations(order: Sequence[PlannedJob]) -> Iterator[List[PlannedJob]]:
    """Yield valid orders in which one of the first jobs stands elsewhere among them."""
    window = min(WINDOW, len(order))
    for taken in range(window):
        for place in range(window):
            if place == taken:
                continue
            rest = [*order[:taken], *order[taken + 1 :]]
            moved = [*rest[:place], order[taken], *rest[place:]]
            if is_valid(moved[:window]):
                yield moved
