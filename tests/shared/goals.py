"""Goals of move_base."""

from move_base_msgs.msg import MoveBaseGoal

from planar_ros.messages.conversion import pose2_to_msg


def goal_at(pose):
    """Return the goal for a pose in the map."""
    goal = MoveBaseGoal()
    goal.target_pose.header.frame_id = "map"
    goal.target_pose.pose = pose2_to_msg(pose)
    return goal
