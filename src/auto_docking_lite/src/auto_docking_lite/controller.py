"""The facade: starts, advances and ends docking and undocking."""

from typing import Optional, Union

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import (
    DockCode,
    DockDecision,
    DockInputs,
    DockResult,
    DockState,
    StagingPort,
)
from auto_docking_lite.docking import Docking
from auto_docking_lite.estimator import DockEstimate
from auto_docking_lite.undocking import Undocking
from planar import Pose2, Twist2


class DockController:
    """Docks and undocks a robot; one task at a time.

    Args:
        settings: Speeds, limits and expected field.
        navigation: Client of move_base; None if only the controller shall drive the robot.
        seed: Seed of the estimator of the dock's pose.

    Attributes:
        navigation: Client of move_base, if there is one.
    """

    def __init__(
        self,
        settings: DockingSettings = DockingSettings(),
        navigation: Optional[StagingPort] = None,
        seed: int = 0,
    ):
        self._settings, self.navigation, self._seed = settings, navigation, seed
        self._task: Union[None, Docking, Undocking] = None
        self._started_at, self._is_cancelled = 0.0, False

    @property
    def is_active(self) -> bool:
        """Whether a task has been started that has not ended."""
        return self._task is not None

    def start(self, now: float, dock_in_map: Optional[Pose2] = None) -> None:
        """Start docking; a task that is active is abandoned.

        Args:
            now: Time [s].
            dock_in_map: Pose of the dock, if it is known.
        """
        self._begin(now, Docking(self._settings, self.navigation, dock_in_map, self._seed))

    def undock(self, now: float) -> None:
        """Start undocking; a task that is active is abandoned.

        Args:
            now: Time [s].
        """
        self._begin(now, Undocking(self._settings))

    def cancel(self, now: float) -> None:
        """End the task at the next tick.

        Args:
            now: Time [s].
        """
        self._is_cancelled = self.is_active

    def estimate(self) -> Optional[DockEstimate]:
        """Return the estimated pose of the dock in odom while the robot docks; None if nothing is known."""
        return self._task.estimate() if isinstance(self._task, Docking) else None

    def tick(self, inputs: DockInputs) -> DockDecision:
        """Advance by one control period.

        Args:
            inputs: What is known.

        Returns:
            The velocity to send, state and, at the end, the result.
        """
        if self._task is None:
            return DockDecision(None, DockState.IDLE)
        if self._is_cancelled:
            return self._end(DockCode.CANCELLED, "Cancelled: Cancel requested.")
        limit = self._settings.docking_timeout
        if inputs.stamp - self._started_at > limit:
            code = DockCode.TIMEOUT
            return self._end(code, f"Aborted: {code.name} ({int(code)}): not done within {limit:g} s.")
        decision = self._task.tick(inputs)
        if decision.result is not None:
            self._task = None
        return decision

    def _begin(self, now: float, task: Union[Docking, Undocking]) -> None:
        if self._task is not None:
            self._task.stop()
        self._task, self._started_at, self._is_cancelled = task, now, False

    def _end(self, code: DockCode, text: str) -> DockDecision:
        assert self._task is not None
        self._task.stop()
        self._task = None
        return DockDecision(Twist2(), DockState.IDLE, text, DockResult(code, text))
