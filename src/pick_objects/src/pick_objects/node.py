"""The ROS node of pick_objects: orders become move_base goals, results become events."""

import sys
import time

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_msgs.msg import String

from pick_objects.config import ErrandSettings, NodeSettings
from pick_objects.errand import Errand, ErrandState, Finish, GoalReached, GoalRefused, GoTo
from planar.places import places_of_errand, why_unreachable
from planar_ros.actions import server_is_ready
from planar_ros.messages import OccupancyGridArrays, grid_from_msg, pose2_to_msg
from planar_ros.parameters import read_settings
from planar_ros.shell import fail, run
from planar_ros.waiting import Waiting

POLL_SECONDS = 0.02
ANNOUNCEMENTS = {
    ErrandState.GOING_TO_PICKUP: "driving to the pick-up zone",
    ErrandState.PICKING_UP: "arrived at the pick-up zone, picking up",
    ErrandState.GOING_TO_DROPOFF: "picked up, driving to the drop-off zone",
    ErrandState.DELIVERED: "arrived at the drop-off zone, delivered",
    ErrandState.FAILED: "the errand has failed",
}


class PickObjects:
    """Runs one errand against the move_base action, then ends the process."""

    def __init__(self):
        node_fields = NodeSettings.__dataclass_fields__
        self._settings = read_settings(NodeSettings, ignore=ErrandSettings.__dataclass_fields__)
        errand_settings = read_settings(ErrandSettings, ignore=node_fields)
        self._places = places_of_errand(self._settings.zones_file)
        self._errand = Errand(*self._places, errand_settings)
        self._state = rospy.Publisher("~state", String, queue_size=10, latch=True)
        self._map = None
        self._pending = False
        self._client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        rospy.Subscriber("map", OccupancyGridArrays, self._keep_map, queue_size=1)
        Waiting(
            {
                f"a map on {rospy.resolve_name('map')}": lambda: self._map is not None,
                f"the action {rospy.resolve_name('move_base')}": self._is_server_ready,
            }
        )

    def work(self) -> Finish:
        """Carries the errand out and says how it ended."""
        self._tell_state()
        obstacle = self._why_not_to_start()
        if obstacle and not rospy.is_shutdown():
            return Finish(False, obstacle)
        state, event = self._errand.state, None
        while not rospy.is_shutdown():
            order = self._errand.advance(rospy.get_time(), event)
            if self._errand.state is not state:
                state = self._errand.state
                self._tell_state()
            if isinstance(order, Finish):
                self._client.cancel_all_goals()
                return order
            if isinstance(order, GoTo):
                self._send(order)
            event = self._next_event()
        return Finish(False, "interrupted")

    def _why_not_to_start(self):
        self._wait_for(lambda: self._map is not None, self._settings.map_timeout)
        if self._map is None:
            rospy.logwarn("no map within %g s: the zones are not checked", self._settings.map_timeout)
        else:
            for place in self._places:
                problem = why_unreachable(place, self._map)
                if problem:
                    return problem
        self._wait_for(self._is_server_ready, self._settings.server_timeout)
        if not self._is_server_ready():
            return f"no action {rospy.resolve_name('move_base')} within {self._settings.server_timeout:g} s"
        return None

    def _is_server_ready(self):
        return server_is_ready(self._client)

    @staticmethod
    def _wait_for(is_there, seconds):
        deadline = time.monotonic() + seconds
        while not is_there() and time.monotonic() < deadline and not rospy.is_shutdown():
            time.sleep(POLL_SECONDS)

    def _send(self, order: GoTo):
        goal = MoveBaseGoal()
        goal.target_pose.header.frame_id = self._settings.frame_id
        goal.target_pose.header.stamp = rospy.Time.now()
        goal.target_pose.pose = pose2_to_msg(order.place.pose)
        self._client.send_goal(goal)
        if order.attempt > 1:
            rospy.logwarn("place %s: attempt %d", order.place.name, order.attempt)
        self._pending = True

    def _next_event(self):
        time.sleep(POLL_SECONDS)
        if not self._pending:
            return None
        status = self._client.get_state()
        if status in (GoalStatus.PENDING, GoalStatus.ACTIVE):
            return None
        self._pending = False
        if status == GoalStatus.SUCCEEDED:
            return GoalReached()
        text = self._client.get_goal_status_text() or GoalStatus.to_string(status)
        rospy.logwarn("place %s: %s", self._errand.place.name, text)
        return GoalRefused(text)

    def _tell_state(self):
        self._state.publish(self._errand.state.value)
        if self._errand.state in ANNOUNCEMENTS:
            rospy.loginfo("%s", ANNOUNCEMENTS[self._errand.state])

    def _keep_map(self, message):
        self._map = grid_from_msg(message)


def main():
    def start():
        node = PickObjects()
        outcome = node.work()
        if not outcome.success:
            fail(outcome.reason, exit_code=1)
        rospy.loginfo("%s", outcome.reason)
        rospy.signal_shutdown("errand done")

    run("pick_objects", start)
    sys.exit(0)
