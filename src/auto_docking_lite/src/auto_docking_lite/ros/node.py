"""The node ``dock_drive``: the action of kobuki_auto_docking, and one that undocks."""

from typing import Optional

import rospy
from geometry_msgs.msg import Twist, Vector3
from kobuki_msgs.msg import AutoDockingAction, AutoDockingFeedback, AutoDockingResult
from std_msgs.msg import String

from auto_docking_lite.config import NodeSettings
from auto_docking_lite.contract import DockCode, DockDecision, DockResult
from auto_docking_lite.controller import DockController
from auto_docking_lite.estimator import warm_up
from auto_docking_lite.ros.inputs import DockTopics
from planar import Pose2, Twist2
from planar.geometry.pose import pose_of_text
from planar_ros.calls.actions import ActionServer
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.transforms import Transforms
from planar_ros.node.parameters import read_settings
from planar_ros.node.runner import run
from planar_ros.node.topics import flush_and_close

CANCELLED = "Cancelled: Cancel requested."
PREEMPTED = "Preempted: New goal received."
SHUTDOWN = "Aborted: Shutdown requested."
TIME_JUMP = "Aborted: time has jumped back."
# Parameters of kobuki_auto_docking without effect here.
UNUSED = ("min_abs_v", "min_abs_w")


class DockActions:
    """The actions that dock and undock, of which one goal at a time is executed.

    Args:
        names: Names of the actions.
    """

    def __init__(self, *names: str):
        self._servers = {name: ActionServer(name, AutoDockingAction, auto_start=False) for name in names}
        for server in self._servers.values():
            server.start()

    def accept(self) -> Optional[str]:
        """Accept a new goal, which preempts the present one; return the action's name, None without one."""
        for name, server in self._servers.items():
            if server.is_new_goal_available():
                self.end(DockResult(DockCode.CANCELLED, PREEMPTED))
                server.accept_new_goal()
                return name
        return None

    def is_cancelled(self) -> bool:
        """Return whether the present goal has been cancelled."""
        return any(server.is_active() and server.is_preempt_requested() for server in self._servers.values())

    def report(self, decision: DockDecision) -> None:
        """Publish the feedback of a tick."""
        for server in self._servers.values():
            if server.is_active():
                server.publish_feedback(AutoDockingFeedback(decision.state.value, decision.text))

    def end(self, result: DockResult) -> None:
        """End the present goal, if there is one."""
        message = AutoDockingResult(result.text)
        for server in self._servers.values():
            if not server.is_active():
                continue
            if result.is_success:
                server.set_succeeded(message, result.text)
            elif result.code is DockCode.CANCELLED:
                server.set_preempted(message, result.text)
            else:
                server.set_aborted(message, result.text)

    def close(self) -> None:
        """Wait until the last results have been received."""
        for server in self._servers.values():
            flush_and_close(server.action_server.result_pub)


class AutoDocking:
    """Passes inputs to a DockController, ticks it in ROS time and publishes what it decides."""

    def __init__(self):
        step = LockstepClient.of_node()
        self._settings = settings = read_settings(NodeSettings)
        for name in UNUSED:
            if rospy.has_param(f"~{name}"):
                where = rospy.resolve_name(f"~{name}")
                rospy.loginfo("%s has no effect: small velocities are sent as they are", where)
        self._dock: Optional[Pose2] = pose_of_text(settings.dock, "~dock") if settings.dock else None
        warm_up()
        rospy.on_shutdown(self._on_shutdown)  # registered before the action servers, so that it runs first
        self._velocity = rospy.Publisher("~velocity", Twist, queue_size=10, tcp_nodelay=True)
        self._debug = rospy.Publisher("~debug/feedback", String, queue_size=10)
        self._topics = DockTopics(settings, Transforms())
        navigation = MoveBaseClient(settings.global_frame) if settings.use_move_base else None
        self._controller = DockController(settings, navigation)
        name = rospy.get_name().rpartition("/")[2]
        self._undock = f"{name}_undock_action"
        self._actions = DockActions(f"{name}_action", self._undock)
        self._decision: Optional[DockDecision] = None
        self._silent_since: Optional[float] = None
        step.every(lambda: settings.period, self._tick, self._on_time_jump, reports=True)
        step.join()

    def _tick(self, now: rospy.Time) -> None:
        stamp = now.to_sec()
        accepted = self._actions.accept()
        if accepted is not None:
            if accepted == self._undock:
                self._controller.undock(stamp)
            else:
                self._controller.start(stamp, self._dock)
            rospy.loginfo("%s: new goal received and accepted", accepted)
        inputs = self._topics.collect(stamp)
        if not self._controller.is_active:
            return
        if self._actions.is_cancelled():
            self._controller.cancel(stamp)
        silent = self._topics.silent(stamp)
        if not silent:
            self._silent_since = None
        elif self._is_silent_for_long(stamp):
            self._abort(f"no messages on {', '.join(silent)}")
            return
        if inputs is not None and not silent:
            self._publish(self._controller.tick(inputs))

    def _is_silent_for_long(self, stamp: float) -> bool:
        """Stop while inputs are missing; return whether they have been missing for too long."""
        self._silent_since = stamp if self._silent_since is None else self._silent_since
        self._send(Twist2())
        return stamp - self._silent_since > self._settings.blocked_timeout

    def _abort(self, reason: str) -> None:
        code = DockCode.FAILED_TO_CONTROL
        self._controller = DockController(self._settings, self._controller.navigation)
        text = f"Aborted: {code.name} ({int(code)}): {reason}."
        rospy.logerr("%s", text)
        self._actions.end(DockResult(code, text))

    def _publish(self, decision: DockDecision) -> None:
        last, self._decision = self._decision, decision
        if last is None or (decision.state, decision.text) != (last.state, last.text):
            rospy.loginfo("%s: %s", decision.state.value, decision.text)
        if decision.command is not None:
            self._send(decision.command)
        self._debug.publish(f"{decision.state.value}: {decision.text}")
        if decision.result is None:
            self._actions.report(decision)
            return
        log = rospy.loginfo if decision.result.is_success else rospy.logwarn
        log("%s", decision.result.text)
        self._actions.end(decision.result)

    def _send(self, command: Twist2) -> None:
        self._velocity.publish(Twist(linear=Vector3(x=command.v), angular=Vector3(z=command.omega)))

    def _on_time_jump(self) -> None:
        self._topics.clear()
        if self._controller.is_active:
            self._controller = DockController(self._settings, self._controller.navigation)
            self._send(Twist2())
            rospy.logwarn("%s", TIME_JUMP)
            self._actions.end(DockResult(DockCode.UNKNOWN, TIME_JUMP))

    def _on_shutdown(self) -> None:
        if self._controller.is_active:
            self._send(Twist2())
            self._actions.end(DockResult(DockCode.UNKNOWN, SHUTDOWN))
            self._actions.close()


def main():
    run("dock_drive", AutoDocking)
