"""Program ``deliver``: sends a mission file to the action of a running robot and reports its progress."""

import argparse
import sys
import threading
import time
from pathlib import Path
from typing import List, Optional

import actionlib
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import DeliverAction, DeliverGoal, DeliveryState

from pick_objects.mission_file import TEXT_SOURCE
from pick_objects.ros.mission_publisher import delivery_from_msg
from planar_ros.calls.actions import goal_is_over, server_is_ready
from planar_ros.node.runner import init_node
from supervision.interruption import on_signals

POLL_SECONDS, FEEDBACK_SECONDS, CANCEL_SECONDS = 0.1, 2.0, 10.0
SUCCESS, FAILURE, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


def main(arguments: Optional[List[str]] = None) -> int:
    """Run the program; return 0 if all was delivered, 1 if not, 2 for bad input, 130 after Ctrl-C."""
    options = _parser().parse_args(rospy.myargv(arguments)[1:])
    try:
        mission = options.mission.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        return _fail(f"{options.mission}: cannot be read ({getattr(error, 'strerror', None) or error})")
    interrupted = threading.Event()
    on_signals(lambda _number, _frame: interrupted.set())
    if not rosgraph.is_master_online():  # rospy would wait for one and ignore signals
        return _fail(f"no ROS master at {rosgraph.get_master_uri()}")
    init_node("deliver", anonymous=True)
    client = actionlib.SimpleActionClient("deliver", DeliverAction)
    deadline = time.monotonic() + options.server_timeout
    while not server_is_ready(client):
        if time.monotonic() > deadline or interrupted.is_set():
            return _fail(f"no action {rospy.resolve_name('deliver')} within {options.server_timeout:g} s")
        time.sleep(POLL_SECONDS)
    deadline = time.monotonic() + options.timeout
    return _follow(client, DeliverGoal(mission=mission), str(options.mission), interrupted, deadline)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="deliver", description="Send a mission to a running robot and follow it; Ctrl-C cancels it."
    )
    parser.add_argument(
        "mission", type=Path, metavar="FILE", help="YAML of deliveries (docs/reference/missions.md)"
    )
    parser.add_argument(
        "--server_timeout", type=float, default=10.0, help="wall-clock s to wait for the robot"
    )
    parser.add_argument("--timeout", type=float, default=3600.0, help="wall-clock s for the mission")
    return parser


def _follow(client, goal: DeliverGoal, name: str, interrupted: threading.Event, deadline: float) -> int:
    """Send the goal and print its progress; ``name``: file that it was read from."""
    latest = [0.0]

    def print_feedback(feedback):
        state = feedback.state
        if time.monotonic() - latest[0] >= FEEDBACK_SECONDS:
            latest[0] = time.monotonic()
            where = f"{state.delivery}: {state.state} ({state.place})"
            print(f"{100.0 * state.progress:3.0f} %  {where}, about {state.time_left:.0f} s left", flush=True)

    client.send_goal(goal, feedback_cb=print_feedback)
    while not goal_is_over(client):
        if interrupted.is_set() or time.monotonic() > deadline or not server_is_ready(client):
            client.cancel_goal()
            if not _wait_for_end(client, time.monotonic() + CANCEL_SECONDS):
                return _fail("the robot does not answer the cancellation", FAILURE)
            break
        time.sleep(POLL_SECONDS)
    deliveries = getattr(client.get_result(), "deliveries", ())  # a server that died has no result
    for state in deliveries:
        _print_result(state)
    text = client.get_goal_status_text()
    if client.get_state() == GoalStatus.ABORTED and not deliveries:
        return _fail(text.replace(TEXT_SOURCE, name, 1))
    print(text, flush=True)
    if interrupted.is_set():
        return INTERRUPTED
    return SUCCESS if client.get_state() == GoalStatus.SUCCEEDED else FAILURE


def _print_result(state: DeliveryState) -> None:
    delivery = state.delivery
    done, missed = ("delivered", "not delivered") if delivery.destination else ("found", "not found")
    ends = {state.DELIVERED: done, state.CANCELLED: "cancelled"}
    reason = f" ({state.reason})" if state.reason and state.state != state.CANCELLED else ""
    print(f"{delivery.name}: {delivery_from_msg(delivery)}: {ends.get(state.state, missed)}{reason}")


def _wait_for_end(client, deadline: float) -> bool:
    while not goal_is_over(client) and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
    return goal_is_over(client)


def _fail(text: str, code: int = BAD_INPUT) -> int:
    print(f"error: {text}", file=sys.stderr, flush=True)
    return code
