"""The task of undocking: the robot leaves the dock backwards."""

from typing import Optional

from auto_docking_lite.attempts import STOP
from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import DockCode, DockDecision, DockInputs, DockResult, DockState
from auto_docking_lite.motion import is_free, obstacles_in_base
from planar import Pose2, Twist2


class Undocking:
    """Leaves the dock backwards; waits while something is behind the robot.

    Args:
        settings: Distance, speed and time-outs.
    """

    def __init__(self, settings: DockingSettings):
        self._settings = settings
        self._start: Optional[Pose2] = None
        self._blocked_since: Optional[float] = None

    def tick(self, inputs: DockInputs) -> DockDecision:
        """Advance by one control period."""
        settings, base = self._settings, inputs.base_in_odom
        self._start = self._start or base
        left = settings.undock_distance - self._start.distance_to(base)
        if left <= 0.0 and not inputs.charger:
            result = DockResult(DockCode.NONE, "Left the docking station.")
            return DockDecision(STOP, DockState.IDLE, "undocked", result)
        behind = Pose2(-min(max(left, 0.05), 0.2))
        if is_free(obstacles_in_base(inputs.scan), Pose2(), behind, settings.robot_radius):
            self._blocked_since = None
            return DockDecision(Twist2(-settings.undock_speed), DockState.UNDOCKING, "leaving the dock")
        text = "something is behind the robot"
        since = self._blocked_since = inputs.stamp if self._blocked_since is None else self._blocked_since
        if inputs.stamp - since <= settings.blocked_timeout:
            return DockDecision(STOP, DockState.UNDOCKING, text)
        code = DockCode.FAILED_TO_CONTROL
        result = DockResult(code, f"Aborted: {code.name} ({int(code)}): {text}.")
        return DockDecision(STOP, DockState.IDLE, text, result)

    def stop(self) -> None:
        """Nothing has to be ended."""
