"""Clients of actions."""

import actionlib


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
