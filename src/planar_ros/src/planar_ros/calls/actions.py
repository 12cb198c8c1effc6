"""Action server and client checks on top of actionlib."""

from typing import Any, List, Sequence

import actionlib
import rospy

from planar_ros.lockstep import LockstepClient
from planar_ros.node.topics import flush_and_close
from rospy_transport.connections import connected_publishers, is_connected

# Most ended goals in the status message, and most goals tracked before pruning: actionlib searches each new
# goal among the tracked ones.
MAX_ENDED_GOALS, MAX_TRACKED_GOALS = 20, 60
# ROS time within which a server that received a goal publishes its status.
ACKNOWLEDGE_TIME = rospy.Duration(1)
# By which the stamp of a cancel may be ahead of this node's clock.
MAX_CLOCK_SKEW = rospy.Duration(1)
KILLED_TEXT = "Aborting on the goal because the node has been killed"


class ActionServer(actionlib.SimpleActionServer):
    """actionlib's SimpleActionServer with bounded goal lists, for simulated and lock-step time.

    It differs from actionlib's server in these points: status is published at logical instants; goals are
    accepted after ROS time has jumped back; ended goals are pruned, so that a flood of goals does not slow it
    down; and an active goal is aborted on shutdown.

    Args:
        arguments: As for SimpleActionServer.
        named: As for SimpleActionServer.
    """

    def __init__(self, *arguments: Any, **named: Any):
        super().__init__(*arguments, **named)
        rospy.on_shutdown(self._abort_at_end)

    def start(self) -> None:
        """Start the server and publish its status periodically."""
        server, step = self.action_server, LockstepClient.of_node()
        self._publish_status, self._is_status_due = server.publish_status, False
        # In lock-step no status is published while clients connect, since only some of them would receive it.
        if step.is_synchronized:
            server.publish_status = lambda: None
        self._cancel, server.internal_cancel_callback = server.internal_cancel_callback, self._on_cancel
        super().start()
        server.publish_status = self._schedule_status
        if server.status_timer is not None:
            server.status_timer.shutdown()
        period = 1.0 / server.status_frequency
        step.every(lambda: period, lambda _now: self._publish_now(), self._clear_last_cancel)

    def internal_goal_callback(self, goal: Any) -> None:
        """Accept a goal even if an earlier goal has a stamp in the future, because time has jumped back.

        Args:
            goal: actionlib's handle of the new goal.
        """
        with self.lock:
            now = rospy.Time.now()
            for earlier in (self.current_goal, self.next_goal):
                if earlier.get_goal() is not None and earlier.get_goal_id().stamp > now:
                    earlier.get_goal_id().stamp = rospy.Time()
        super().internal_goal_callback(goal)

    def _on_cancel(self, goal_id: Any) -> None:
        """Cancel goals; a stamp ahead of time does not cancel goals that are sent later."""
        server = self.action_server
        with server.lock:
            self._cancel(goal_id)
            server.last_cancel = min(server.last_cancel, rospy.Time.now() + MAX_CLOCK_SKEW)

    def _clear_last_cancel(self) -> None:
        """Keep cancel requests from before a jump back of time from cancelling goals after it."""
        with self.action_server.lock:
            self.action_server.last_cancel = rospy.Time()

    def _schedule_status(self) -> None:
        """Publish the status once for all goals that change at a logical instant, possibly thousands."""
        server = self.action_server
        with server.lock:
            if len(server.status_list) > MAX_TRACKED_GOALS:
                server.status_list[:] = prune_ended(server.status_list)
            if not self._is_status_due:
                self._is_status_due = True
                LockstepClient.of_node().defer(self._publish_now)

    def _publish_now(self) -> None:
        server = self.action_server
        with server.lock:
            self._is_status_due = False
            server.status_list[:] = prune_ended(server.status_list)
            self._publish_status()

    def _abort_at_end(self) -> None:
        with self.action_server.lock, self.lock:
            if self.is_new_goal_available():
                self.accept_new_goal()
            if not self.is_active():
                return
            self.set_aborted(text=KILLED_TEXT)
            self._publish_now()
        flush_and_close(self.action_server.result_pub, self.action_server.status_pub)


def prune_ended(trackers: Sequence[Any]) -> List[Any]:
    """Return actionlib's StatusTrackers without those of ended goals except the last MAX_ENDED_GOALS."""
    ended = [tracker for tracker in trackers if tracker.handle_destruction_time != rospy.Time()]
    dropped = {id(tracker) for tracker in ended[:-MAX_ENDED_GOALS]}
    return [tracker for tracker in trackers if id(tracker) not in dropped]


def server_is_ready(client: actionlib.SimpleActionClient) -> bool:
    """Whether the action's server is connected to this client in both directions.

    Unlike wait_for_server it returns at once, even while simulated time is paused.
    """
    inner = client.action_client
    if inner.last_status_msg is None:
        return False
    # Other nodes may subscribe to goals too, such as rosbag record.
    server = inner.last_status_msg._connection_header["callerid"]
    publishers = (inner.pub_goal, inner.pub_cancel)
    is_subscribed = all(is_connected(publisher, server) for publisher in publishers)
    return is_subscribed and server in connected_publishers(inner.result_sub)


def goal_is_over(client: actionlib.SimpleActionClient) -> bool:
    """Whether the last goal has ended and its result has arrived, which may be later than its state.

    A result that arrives before ``send_goal`` returns is seen only by the goal handle.
    """
    if client.simple_state == actionlib.SimpleGoalState.DONE:
        return True
    return client.gh is not None and client.gh.get_comm_state() == actionlib.CommState.DONE


def server_connection(client: actionlib.SimpleActionClient) -> Any:
    """Return an object that identifies the server's present connection; it changes after a restart.

    None before the first status message.
    """
    status = client.action_client.last_status_msg
    return None if status is None else status._connection_header


def goal_is_lost(client: actionlib.SimpleActionClient, sent_to: Any) -> bool:
    """Whether the last goal was sent to a server that has restarted since and does not know the goal.

    actionlib detects this only for acknowledged goals without a pending result.

    Args:
        client: The client that sent the goal.
        sent_to: ``server_connection`` at the time of sending.
    """
    latest = client.action_client.last_status_msg
    if goal_is_over(client) or client.gh is None or latest is None or server_connection(client) is sent_to:
        return False
    goal_id = client.gh.comm_state_machine.action_goal.goal_id
    is_known = any(status.goal_id.id == goal_id.id for status in latest.status_list)
    return not is_known and latest.header.stamp > goal_id.stamp + ACKNOWLEDGE_TIME
