"""What a plan is made of: jobs and the state from which it starts."""

from dataclasses import dataclass
from typing import Optional, Tuple

from planar import Pose2

CHARGE = "charge"


@dataclass(frozen=True)
class Stop:
    """A place of a job.

    Attributes:
        pose: Pose in the map; None: where the robot is.
        seconds: Time that the robot stands there [s].
    """

    pose: Optional[Pose2]
    seconds: float = 0.0


@dataclass(frozen=True)
class PlannedJob:
    """A task as the plan sees it.

    Attributes:
        id: Id of the task.
        stops: Remaining places in order.
        release: Unix time before which it must not start [s].
        deadline: Unix time by which it is to be done [s]; None: none.
        priority: 0 and up.
        after: Ids of jobs that must be done before.
        is_docking: It ends in the dock.
        keeps_load: It can be done while the object of another task is on board.
    """

    id: str
    stops: Tuple[Stop, ...]
    release: float
    deadline: Optional[float] = None
    priority: int = 0
    after: Tuple[str, ...] = ()
    is_docking: bool = False
    keeps_load: bool = True

    @property
    def weight(self) -> float:
        """Weight of its lateness: a level of priority outweighs four of the level below."""
        return 4.0**self.priority


@dataclass(frozen=True)
class PlanStart:
    """State from which a plan starts.

    Attributes:
        now: Unix time [s].
        pose: Pose of the robot in the map.
        charge: Charge of the battery, 0 to 1; None if there is no battery or no dock.
        is_docked: Whether the robot is in the dock.
        current: Id of the task under way; empty if there is none.
        carrying: Id of the task whose object is on board; empty if there is none.
    """

    now: float
    pose: Pose2
    charge: Optional[float] = None
    is_docked: bool = False
    current: str = ""
    carrying: str = ""


@dataclass(frozen=True)
class PlanEntry:
    """A job, or charging, in a plan.

    Attributes:
        id: Id of the task; CHARGE for charging.
        start: Unix time at which it starts [s].
        end: Unix time at which it ends [s].
        is_late: It ends after its deadline.
        charge: Charge at its end; for charging the charge to reach.
    """

    id: str
    start: float
    end: float
    is_late: bool = False
    charge: Optional[float] = None


@dataclass(frozen=True)
class QueuePlan:
    """An order of jobs with its costs.

    Attributes:
        entries: Jobs and charging in order.
        cost: Weighted number of missed deadlines, then weighted delay [s]; the smaller is the better plan.
    """

    entries: Tuple[PlanEntry, ...] = ()
    cost: Tuple[float, float] = (0.0, 0.0)

    @property
    def first(self) -> Optional[PlanEntry]:
        """What comes first; None if nothing is to be done."""
        return self.entries[0] if self.entries else None

    def entry(self, job_id: str) -> Optional[PlanEntry]:
        """Return the entry of a job."""
        return next((entry for entry in self.entries if entry.id == job_id), None)
