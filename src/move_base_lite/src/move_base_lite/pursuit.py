"""The pursuit of one goal: since when what has failed, and how far recovery has come."""

from dataclasses import dataclass
from typing import Optional, Tuple

from move_base_lite.decision import Outcome, Progress, Status, Trigger
from move_base_lite.errors import NavigationError
from move_base_lite.recovery import Recovery, SpeedLimit
from planar import Pose2, wrap

# Metres after which the speed so far tells how long the rest will take.
TELLING_DISTANCE = 1.0


@dataclass
class Pursuit:
    """What the Navigator remembers while it has a goal; ``pose`` is where the robot was seen last."""

    goal: Pose2
    started: float
    pose: Pose2
    progress_pose: Pose2
    last_progress: float
    planning_since: float
    next_plan: float
    status: Status = Status.PLANNING
    trigger: Trigger = Trigger.PLANNING
    control_fails_since: Optional[float] = None
    failed_plans: int = 0
    recovery_index: int = 0
    recovery: Optional[Recovery] = None
    reason: Optional[NavigationError] = None
    travelled: float = 0.0
    recoveries_used: int = 0
    slow: Optional[Tuple[SpeedLimit, Pose2]] = None

    @classmethod
    def of(cls, goal: Pose2, now: float, base_in_map: Pose2) -> "Pursuit":
        """A pursuit that begins now and here."""
        return cls(goal, now, base_in_map, base_in_map, now, now, now)

    def advance(self, now: float, base_in_map: Pose2, oscillation_distance: float) -> None:
        """The robot has moved on; so many metres from where it was before are progress."""
        self.travelled += self.pose.distance_to(base_in_map)
        self.pose = base_in_map
        if base_in_map.distance_to(self.progress_pose) >= oscillation_distance:
            self.progress_pose, self.last_progress = base_in_map, now
            self.has_overcome(Trigger.OSCILLATION)

    def has_overcome(self, trigger: Trigger) -> None:
        """What recovery was begun for is no more: the next trouble starts with the first behaviour."""
        if self.trigger is trigger:
            self.recovery_index = 0

    def clear_up(self, trigger: Trigger) -> None:
        """Recovery is to begin."""
        self.status, self.trigger = Status.CLEARING, trigger

    def plan_anew(self, now: float) -> None:
        """Another plan is to be made, with full patience."""
        self.status = Status.PLANNING
        self.planning_since, self.failed_plans = now, 0

    def end_recovery(self, now: float) -> None:
        """One behaviour has ended; the next trouble gets the next one."""
        self.recovery = None
        self.recovery_index += 1
        self.last_progress, self.control_fails_since = now, None
        self.plan_anew(now)

    def progress(self, now: float, distance_left: float, usual_speed: float) -> Progress:
        """How it stands; before the robot's own speed tells, the usual one says how long the rest takes."""
        seconds = now - self.started
        speed = self.travelled / seconds if self.travelled > TELLING_DISTANCE else usual_speed
        return Progress(seconds, self.travelled, self.recoveries_used, distance_left, distance_left / speed)

    def outcome(self, now: float, code: int, reason: str, text: str) -> Outcome:
        """How it ended."""
        return Outcome(
            code,
            reason,
            text,
            self.pose.distance_to(self.goal),
            abs(wrap(self.goal.yaw - self.pose.yaw)),
            self.recoveries_used,
            now - self.started,
        )
