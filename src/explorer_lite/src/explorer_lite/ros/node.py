"""The ROS node of explorer_lite: serves the action ``explore`` with goals for move_base."""

import time
from dataclasses import asdict, replace
from typing import Any, Optional, Tuple, Union

import rospy
from geometry_msgs.msg import Point, PoseStamped
from home_service_msgs.msg import ExploreAction, ExploreActionGoal, ExploreFeedback, ExploreResult
from visualization_msgs.msg import MarkerArray

from explorer_lite.config import ExplorerSettings, NodeSettings
from explorer_lite.explorer import (
    Explorer,
    ExplorerState,
    FinishTask,
    GoalFailed,
    GoalReached,
    SendGoal,
    warm_up,
)
from explorer_lite.ros.markers import frontier_markers
from planar import OccupancyGrid, Pose2
from planar_ros.calls.actions import ActionServer
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import LaserScanArrays, OccupancyGridArrays, grid_from_msg, pose2_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import subscribe
from planar_ros.node.checkpoint import ParameterCheckpoint
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run

POLL_SECONDS = 0.02
FEEDBACK_SECONDS = 1.0
STOP_SECONDS = 2.0


class Autostart:
    """Sends the node an ``explore`` goal at the start, and resumes this exploration after a crash.

    The goal is published on the action's topic, so other clients of the action see a normal goal. The
    checkpoint belongs to this goal alone, not to goals of other clients.

    Args:
        return_to_start: Whether the robot returns to its start pose at the end.
    """

    def __init__(self, return_to_start: bool):
        self._goal = ExploreActionGoal()
        self._goal.goal.return_to_start = return_to_start
        self._goal.goal_id.id = f"{rospy.get_name()}-autostart"
        self._goals = rospy.Publisher("explore/goal", ExploreActionGoal, queue_size=1)
        self._checkpoint = ParameterCheckpoint()
        left = self._checkpoint.recovered(_autostart_checkpoint)
        self.start, self._is_sent = (None, False) if left is None else left

    def is_goal(self, goal_id: str) -> bool:
        """Whether it has sent the goal of this id."""
        return goal_id == self._goal.goal_id.id

    def save(self, start: Optional[Pose2], is_over: bool = False) -> None:
        """Save the pose to return to, and whether the exploration has ended."""
        self._checkpoint.save({"start": start and asdict(start), "is_over": is_over})

    def send_goal(self) -> None:
        """Send the goal once the action server is connected."""
        if not self._is_sent and self._goals.get_num_connections() > 0:
            self._is_sent = True
            self._goals.publish(self._goal)


def _autostart_checkpoint(record: Any) -> Tuple[Optional[Pose2], bool]:
    """Return the pose to return to, and whether the exploration has ended."""
    start = record["start"]
    return None if start is None else Pose2.from_dict(start), bool(record["is_over"])


class Explore:
    """Serves the action ``explore``; sends the explorer's orders to move_base."""

    def __init__(self):
        node_fields, explorer_fields = (
            kind.__dataclass_fields__ for kind in (NodeSettings, ExplorerSettings)
        )
        self._step = LockstepClient.of_node()
        self._settings = read_settings(NodeSettings, ignore=explorer_fields)
        self._explorer_settings = read_settings(ExplorerSettings, ignore=node_fields)
        warm_up()
        self._map: Optional[OccupancyGrid] = None
        self._field_of_view = 0.0
        self._transforms = Transforms()
        self._markers = rospy.Publisher("~frontiers", MarkerArray, queue_size=1, latch=True)
        self._move_base = MoveBaseClient(self._settings.global_frame)
        subscribe("map", OccupancyGridArrays, self._on_map, queue_size=1, tcp_nodelay=True)
        self._scans = subscribe("scan", LaserScanArrays, self._on_scan, queue_size=1)
        self._move_base.cancel_on_shutdown()
        frames = f"{self._settings.global_frame} to {self._settings.robot_base_frame}"
        self._conditions = {
            f"a map on {rospy.resolve_name('map')}": lambda: self._map is not None,
            f"the transform {frames}": lambda: self._robot() is not None,
            self._move_base.name: self._move_base.is_ready,
        }
        ReadinessMonitor(self._conditions)
        self._server = ActionServer("explore", ExploreAction, auto_start=False)
        self._server.start()
        self._autostart = Autostart(self._settings.return_to_start) if self._settings.autostart else None

    def serve(self) -> None:
        """Execute goals until shutdown."""
        self._step.join(takes_turns=True)
        while not rospy.is_shutdown():
            if self._autostart is not None and all(is_met() for is_met in self._conditions.values()):
                self._autostart.send_goal()
            if self._server.is_new_goal_available():
                self._execute(self._server.accept_new_goal())
            self._step.pause(POLL_SECONDS)

    def _execute(self, goal):
        settings = self._explorer_settings
        if settings.field_of_view == 0.0:
            settings = replace(settings, field_of_view=self._field_of_view)
        if self._field_of_view > 0.0:
            self._scans.unregister()
        autostart = self._autostart
        if autostart is not None and not autostart.is_goal(self._server.current_goal.get_goal_id().id):
            autostart = None
        before = None if autostart is None else autostart.start
        explorer = Explorer(settings, goal.return_to_start, before)
        start = rospy.get_time()
        rospy.loginfo("exploring")
        end = self._explore(explorer, autostart)
        if rospy.is_shutdown():  # the action has then been aborted
            return
        self._stop()
        result = ExploreResult(
            explored_area=explorer.explored_area,
            duration=rospy.Duration(max(0.0, rospy.get_time() - start)),
            unreachable=[Point(*frontier.middle_xy, 0.0) for frontier in explorer.unreachable],
        )
        if end is None:
            rospy.loginfo("exploration cancelled")
            self._server.set_preempted(result, "cancelled")
        elif end.success:
            rospy.loginfo("%s", end.reason)
            self._server.set_succeeded(result, end.reason)
        else:
            rospy.logwarn("%s", end.reason)
            self._server.set_aborted(result, end.reason)
        if autostart is not None:
            autostart.save(explorer.start, is_over=True)

    def _explore(self, explorer: Explorer, autostart: Optional[Autostart]) -> Optional[FinishTask]:
        """Explore to the end; None if the goal was cancelled."""
        last_map, event, goal = None, None, None
        next_feedback = 0.0
        complete_at = time.monotonic()
        while not (rospy.is_shutdown() or self._server.is_preempt_requested()):
            missing = [name for name, is_met in self._conditions.items() if not is_met()]
            if not missing:
                complete_at = time.monotonic()
            elif time.monotonic() - complete_at > self._settings.server_timeout:
                text = f"{' and '.join(missing)} missing for {self._settings.server_timeout:g} s"
                return FinishTask(False, text)
            now, grid, robot = rospy.get_time(), self._map, self._robot()
            order = None
            if not missing and robot is not None:
                order = explorer.advance(now, None if grid is last_map else grid, robot, event)
                last_map, event = grid, None
            if isinstance(order, FinishTask):
                return order
            if autostart is not None and explorer.start is not None:
                autostart.save(explorer.start)
            if isinstance(order, SendGoal):
                goal = order.pose
                self._move_base.send(goal)
            if explorer.state is not ExplorerState.READY and now >= next_feedback:
                next_feedback = now + FEEDBACK_SECONDS
                self._publish_feedback(explorer, goal)
            self._step.pause(POLL_SECONDS)
            event = event or self._next_event()
        return None

    def _stop(self) -> None:
        """Cancel the move_base goal and wait briefly until it has ended."""
        self._move_base.cancel()
        deadline = time.monotonic() + STOP_SECONDS
        while not self._move_base.is_idle and time.monotonic() < deadline:
            self._step.pause(POLL_SECONDS)

    def _robot(self) -> Optional[Pose2]:
        return self._transforms.lookup(self._settings.global_frame, self._settings.robot_base_frame)

    def _next_event(self) -> Union[None, GoalReached, GoalFailed]:
        outcome = self._move_base.outcome()
        event = None if outcome is None else outcome.event
        if isinstance(event, GoalFailed):
            rospy.loginfo("move_base goal failed: %s", event.reason)
        return event

    def _publish_feedback(self, explorer: Explorer, goal: Optional[Pose2]):
        self._server.publish_feedback(
            ExploreFeedback(
                explored_area=explorer.explored_area,
                frontiers=len(explorer.frontiers),
                goal=self._stamped(goal) if goal else PoseStamped(),
                state=explorer.state.value,
            )
        )
        self._markers.publish(
            frontier_markers(explorer.frontiers, explorer.unreachable, self._settings.global_frame)
        )

    def _stamped(self, pose: Pose2) -> PoseStamped:
        stamped = PoseStamped(pose=pose2_to_msg(pose))
        stamped.header.frame_id, stamped.header.stamp = self._settings.global_frame, rospy.Time.now()
        return stamped

    def _on_scan(self, scan):
        self._field_of_view = len(scan.ranges) * abs(scan.angle_increment)

    def _on_map(self, message):
        self._map = grid_from_msg(message)


def main():
    run("explore", lambda: Explore().serve())
