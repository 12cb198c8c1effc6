"""Clients and servers of actions."""

import actionlib
import rospy


class ActionServer(actionlib.SimpleActionServer):
    """A server that tells its status also after time was set back, which ends actionlib's own timer."""

    def start(self) -> None:
        super().start()
        server = self.action_server
        if server.status_timer is not None:
            server.status_timer.shutdown()
            period = rospy.Duration(1.0 / server.status_frequency)
            server.status_timer = rospy.Timer(period, server.publish_status_async, reset=True)


def server_is_ready(client: actionlib.SimpleActionClient) -> bool:
    """Whether the action's server is there and hears and answers this client.

    Unlike wait_for_server it answers at once, also while simulated time stands still.
    """
    inner = client.action_client
    return (
        inner.last_status_msg is not None
        and inner.pub_goal.get_num_connections() > 0
        and inner.pub_cancel.get_num_connections() > 0
        and inner.result_sub.get_num_connections() > 0
    )


def goal_is_over(client: actionlib.SimpleActionClient) -> bool:
    """Whether the last goal has ended and its result has come, which may be later than its state."""
    return client.simple_state == actionlib.SimpleGoalState.DONE
