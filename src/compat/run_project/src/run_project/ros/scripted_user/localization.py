"""Where Am I: the robot is sent to a place in sight and back, or turned, and has to know where it is."""

import math
from typing import TYPE_CHECKING, List

import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseActionResult

from planar import Pose2
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.node.listeners import has_all_subscribers

if TYPE_CHECKING:
    from run_project.ros.scripted_user.user import ScriptedUser

# Metres by which the robot may be wrong; how far it is sent, and the share of what is free.
MAX_ERROR, MAX_GOAL_DISTANCE, DISTANCE_FRACTION = 0.3, 2.0, 0.6
# Simulated seconds for a goal, and rad/s to turn round once.
GOAL_SECONDS, TURN_RATE = 120.0, 0.5
SETTLE_SECONDS = 2.0
SUCCEEDED = 3
# Metres and radians without which being localized proves nothing.
MIN_MOTION = 0.5


def check_localization(user: "ScriptedUser") -> None:
    """Sends the robot there and back where it has a move_base, else turns it; looks how far off it is."""
    user.wait(lambda: user.has_node("amcl"), 120.0, "no amcl ran", is_wall=True)
    transforms = Transforms()
    frames = (
        rospy.get_param("/amcl/global_frame_id", "map"),
        rospy.get_param("/amcl/base_frame_id", "base_link"),
    )
    global_frame, base_frame = (frame.lstrip("/") for frame in frames)
    user.wait(
        lambda: transforms.lookup(global_frame, base_frame) is not None,
        120.0,
        f"no transform from {global_frame} to {base_frame}",
        is_wall=True,
    )
    begun = transforms.lookup(global_frame, base_frame)
    assert begun is not None
    if user.find_topic("actionlib_msgs/GoalStatusArray"):
        bearing = user.bearing_with_most_space()
        distance = min(MAX_GOAL_DISTANCE, DISTANCE_FRACTION * user.free_distance(bearing))
        there = begun @ Pose2(distance * math.cos(bearing), distance * math.sin(bearing), bearing)
        _send_goal(user, there, global_frame)
        _send_goal(user, begun, global_frame)
    else:
        since = rospy.get_time()
        while not user.wait(lambda: rospy.get_time() - since > math.tau / TURN_RATE, 0.2):
            user.drive(0.0, TURN_RATE)
        user.drive(0.0, 0.0)
    user.sleep(SETTLE_SECONDS)
    estimate = transforms.lookup(global_frame, base_frame)
    assert estimate is not None
    off = estimate.distance_to(user.base)
    user.add_check(user.total_motion > MIN_MOTION, f"moved by {user.total_motion:.0f} m and rad")
    user.add_check(off < MAX_ERROR, f"localized within {off:.2f} m (at most {MAX_ERROR:g} m off)")


def _send_goal(user: "ScriptedUser", place: Pose2, frame: str) -> None:
    """As with rviz's 2D Nav Goal."""
    results: List[MoveBaseActionResult] = []
    listener = rospy.Subscriber("/move_base/result", MoveBaseActionResult, results.append, queue_size=5)
    goals = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
    user.wait(lambda: has_all_subscribers(goals), 60.0, "no move_base listened", is_wall=True)
    goal = PoseStamped()
    goal.header.frame_id, goal.header.stamp, goal.pose = frame, rospy.get_rostime(), pose2_to_msg(place)
    goals.publish(goal)
    is_there = user.wait(lambda: bool(results), GOAL_SECONDS) and results[0].status.status == SUCCEEDED
    if not results:
        canceller = rospy.Publisher("/move_base/cancel", GoalID, queue_size=1)
        user.wait(lambda: has_all_subscribers(canceller), 10.0, is_wall=True)
        canceller.publish(GoalID())
        user.wait(lambda: bool(results), SETTLE_SECONDS)
    listener.unregister()
    user.log(f"{'reached' if is_there else 'did not reach'} ({place.x:.2f}, {place.y:.2f})")
