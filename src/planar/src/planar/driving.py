"""What a task and whoever drives the robot for it tell each other; pure, so that both can be rehearsed."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Finish:
    """Order: the task is over, and why."""

    success: bool
    reason: str


@dataclass(frozen=True)
class GoalReached:
    """Event: the robot has arrived where the last order sent it."""


@dataclass(frozen=True)
class GoalRefused:
    """Event: the robot gave the last order up, and why."""

    reason: str
