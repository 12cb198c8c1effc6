"""Where Am I: sends the robot to a visible position and back, or turns it, and checks its pose estimate."""

import math
from typing import TYPE_CHECKING, List

import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseActionResult

from planar import Pose2
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.node.topics import has_all_subscribers

if TYPE_CHECKING:
    from run_project.ros.scripted_user.user import ScriptedUser

# Allowed position error [m]; distance of the goal [m], and its fraction of the free distance.
MAX_ERROR, MAX_GOAL_DISTANCE, DISTANCE_FRACTION = 0.3, 2.0, 0.6
# Simulated time for a goal [s], and rate of the turn on the spot [rad/s].
GOAL_SECONDS, TURN_RATE = 120.0, 0.5
SETTLE_SECONDS = 2.0
SUCCEEDED = 3
# Motion, in metres plus radians, below which the check would prove nothing.
MIN_MOTION = 0.5


def check_localization(user: "ScriptedUser") -> None:
    """Check the pose estimate after two goals with move_base, or after a turn on the spot without it."""
    user.wait(lambda: user.has_node("amcl"), 120.0, "no node amcl", is_wall=True)
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
    start = transforms.lookup(global_frame, base_frame)
    assert start is not None
    if user.find_topic("actionlib_msgs/GoalStatusArray"):
        bearing = user.bearing_with_most_space()
        distance = min(MAX_GOAL_DISTANCE, DISTANCE_FRACTION * user.free_distance(bearing))
        there = start @ Pose2(distance * math.cos(bearing), distance * math.sin(bearing), bearing)
        _send_goal(user, there, global_frame)
        _send_goal(user, start, global_frame)
    else:
        since = rospy.get_time()
        while not user.wait(lambda: rospy.get_time() - since > math.tau / TURN_RATE, 0.2):
            user.drive(0.0, TURN_RATE)
        user.drive(0.0, 0.0)
    user.sleep(SETTLE_SECONDS)
    estimate = transforms.lookup(global_frame, base_frame)
    assert estimate is not None
    frame = user.alignment.map_in_world()
    if frame != Pose2():
        user.log(f"the map's origin lies at ({frame.x:.2f}, {frame.y:.2f}), {frame.yaw:.2f} rad in the world")
    error = (frame @ estimate).distance_to(user.base)
    user.add_check(user.total_motion > MIN_MOTION, f"moved by {user.total_motion:.0f} m and rad")
    user.add_check(error < MAX_ERROR, f"localized within {error:.2f} m (at most {MAX_ERROR:g} m)")


def _send_goal(user: "ScriptedUser", place: Pose2, frame: str) -> None:
    """Send a goal as rviz's 2D Nav Goal does, and wait until it ends."""
    results: List[MoveBaseActionResult] = []
    listener = rospy.Subscriber("/move_base/result", MoveBaseActionResult, results.append, queue_size=5)
    goals = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
    user.wait(
        lambda: has_all_subscribers(goals), 60.0, "no node subscribes to /move_base_simple/goal", is_wall=True
    )
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
