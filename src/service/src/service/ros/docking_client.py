"""Client of the actions that dock and undock (kobuki_auto_docking, auto_docking_lite)."""

from typing import Any, Optional, Tuple

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from kobuki_msgs.msg import AutoDockingAction, AutoDockingGoal

from planar_ros.calls.actions import goal_is_over, server_is_ready
from service.execution.robot import DockingFailed, RobotDocked, RobotEvent, RobotUndocked

ACTIONS = ("dock_drive_action", "dock_drive_undock_action")
# ROS time in which an action has to end [s].
TIMEOUT = 300.0


class DockingClient:
    """Sends goals to the docking actions, one at a time."""

    def __init__(self) -> None:
        self._clients = [actionlib.SimpleActionClient(name, AutoDockingAction) for name in ACTIONS]
        self._active: Optional[Tuple[Any, RobotEvent, float]] = None

    def dock(self, now: float) -> None:
        """Drive into the dock; ``now`` is ROS time [s]."""
        self._send(0, RobotDocked(), now)

    def undock(self, now: float) -> None:
        """Leave the dock."""
        self._send(1, RobotUndocked(), now)

    def cancel(self) -> None:
        """Cancel what was ordered last."""
        if self._active is not None and self._active[0] is not None and not goal_is_over(self._active[0]):
            self._active[0].cancel_goal()
        self._active = None

    def event(self, now: float) -> Optional[RobotEvent]:
        """Return the outcome of the last order once; None while it is active and afterwards."""
        if self._active is None:
            return None
        client, success, since = self._active
        if client is None:
            self._active = None
            return DockingFailed(f"there is no action {rospy.resolve_name(ACTIONS[0])}")
        if not goal_is_over(client):
            if now - since <= TIMEOUT:
                return None
            self.cancel()
            return DockingFailed(f"not done within {TIMEOUT:g} s")
        self._active = None
        if client.get_state() == GoalStatus.SUCCEEDED:
            return success
        return DockingFailed(client.get_goal_status_text() or GoalStatus.to_string(client.get_state()))

    def _send(self, number: int, success: RobotEvent, now: float) -> None:
        client = self._clients[number] if server_is_ready(self._clients[number]) else None
        if client is not None:
            client.send_goal(AutoDockingGoal())
        self._active = (client, success, now)
