"""Clients and servers of actions."""

import actionlib

from planar_ros.step import Step


class ActionServer(actionlib.SimpleActionServer):
    """A server that tells its status at moments, and also after time was set back, unlike actionlib's own."""

    def start(self) -> None:
        server, step = self.action_server, Step.of_node()
        tell = server.publish_status
        if step.is_on:  # clients connect between this moment and the next, and either all hear it or none
            server.publish_status = lambda: None
        super().start()
        server.publish_status = tell
        if server.status_timer is not None:
            server.status_timer.shutdown()
        period = 1.0 / server.status_frequency
        step.every(lambda: period, lambda _now: tell(), lambda: None)


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
