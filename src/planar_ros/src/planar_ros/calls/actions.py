"""Clients and servers of actions."""

from typing import Any, List, Sequence

import actionlib
import rospy

from planar_ros.lockstep import LockstepClient
from planar_ros.node.flush import flush_and_close

# Goals that have ended are told of for a while, but of no more than so many, and no more than so many are
# kept: each goal that comes is looked up among them.
MAX_ENDED_GOALS, MAX_TRACKED_GOALS = 20, 60
# Of ROS time, in which a goal that is under way comes to be known.
ACKNOWLEDGE_TIME = rospy.Duration(1)
KILLED_TEXT = "Aborting on the goal because the node has been killed"


class ActionServer(actionlib.SimpleActionServer):
    """A server that tells its status at moments, and also after time was set back, unlike actionlib's own.

    A client that sends goals without end does not slow it down, and none is left waiting when the node ends.
    """

    def __init__(self, *arguments: Any, **named: Any):
        super().__init__(*arguments, **named)
        rospy.on_shutdown(self._abort_at_end)

    def start(self) -> None:
        server, step = self.action_server, LockstepClient.of_node()
        self._publish_status, self._is_to_tell = server.publish_status, False
        if (
            step.is_synchronized
        ):  # clients connect between this moment and the next, and either all hear it or none
            server.publish_status = lambda: None
        super().start()
        server.publish_status = self._tell_soon
        if server.status_timer is not None:
            server.status_timer.shutdown()
        period = 1.0 / server.status_frequency
        step.every(lambda: period, lambda _now: self._tell(), self._forget_cancel)

    def internal_goal_callback(self, goal: Any) -> None:
        """A goal is not old for being stamped before the last one: time may have been set back."""
        with self.lock:
            now = rospy.Time.now()
            for earlier in (self.current_goal, self.next_goal):
                if earlier.get_goal() is not None and earlier.get_goal_id().stamp > now:
                    earlier.get_goal_id().stamp = rospy.Time()
        super().internal_goal_callback(goal)

    def _forget_cancel(self) -> None:
        """Nor is it cancelled by what was stamped later."""
        with self.action_server.lock:
            self.action_server.last_cancel = rospy.Time()

    def _tell_soon(self) -> None:
        """How all goals stand: once for all that have changed at a moment, which may be thousands."""
        server = self.action_server
        with server.lock:
            if len(server.status_list) > MAX_TRACKED_GOALS:
                server.status_list[:] = prune_ended(server.status_list)
            if not self._is_to_tell:
                self._is_to_tell = True
                LockstepClient.of_node().defer(self._tell)

    def _tell(self) -> None:
        server = self.action_server
        with server.lock:
            self._is_to_tell = False
            server.status_list[:] = prune_ended(server.status_list)
            self._publish_status()

    def _abort_at_end(self) -> None:
        with self.action_server.lock, self.lock:
            if self.is_new_goal_available():
                self.accept_new_goal()
            if not self.is_active():
                return
            self.set_aborted(text=KILLED_TEXT)
            self._tell()
        flush_and_close(self.action_server.result_pub, self.action_server.status_pub)


def prune_ended(trackers: Sequence[Any]) -> List[Any]:
    """Drop actionlib's StatusTrackers of ended goals but for the last MAX_ENDED_GOALS."""
    ended = [tracker for tracker in trackers if tracker.handle_destruction_time != rospy.Time()]
    forgotten = {id(tracker) for tracker in ended[:-MAX_ENDED_GOALS]}
    return [tracker for tracker in trackers if id(tracker) not in forgotten]


def server_is_ready(client: actionlib.SimpleActionClient) -> bool:
    """Whether the action's server is there and hears and answers this client.

    Unlike wait_for_server it answers at once, also while simulated time stands still.
    """
    inner = client.action_client
    if inner.last_status_msg is None:
        return False
    # Others may listen to goals, too, as a recorder of bags does.
    server = inner.last_status_msg._connection_header["callerid"]
    publishers = (inner.pub_goal, inner.pub_cancel)
    hears = all(publisher.impl.has_connection(server) for publisher in publishers)
    # rospy counts a connection before it stands, and knows only then whose it is.
    return hears and any(each.callerid_pub == server for each in inner.result_sub.impl.connections)


def goal_is_over(client: actionlib.SimpleActionClient) -> bool:
    """Whether the last goal has ended and its result has come, which may be later than its state.

    Of a result that comes before ``send_goal`` has returned, only the handle of the goal takes note.
    """
    if client.simple_state == actionlib.SimpleGoalState.DONE:
        return True
    return client.gh is not None and client.gh.get_comm_state() == actionlib.CommState.DONE


def server_connection(client: actionlib.SimpleActionClient) -> Any:
    """What stands for the server that was heard last, None before: another one after it was started anew."""
    told = client.action_client.last_status_msg
    return None if told is None else told._connection_header


def goal_is_lost(client: actionlib.SimpleActionClient, sent_to: Any) -> bool:
    """Whether the last goal went to a server that has been restarted since and does not know the goal.

    actionlib sees that only of goals that the server has acknowledged, and that have no result under way.
    """
    told = client.action_client.last_status_msg
    if goal_is_over(client) or client.gh is None or told is None or server_connection(client) is sent_to:
        return False
    goal_id = client.gh.comm_state_machine.action_goal.goal_id
    is_known = any(status.goal_id.id == goal_id.id for status in told.status_list)
    return not is_known and told.header.stamp > goal_id.stamp + ACKNOWLEDGE_TIME
