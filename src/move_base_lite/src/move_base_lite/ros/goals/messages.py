# ruff: noqa: N818  -- the names are the reasons
"""Conversion of goal messages by move_base's rules."""

import math

from geometry_msgs.msg import PoseStamped

from move_base_lite.errors import NavigationError
from planar import Pose2
from planar_ros.messages.conversion import frame_name, pose2_from_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import MessageError

INVALID_QUATERNION = "Aborting on goal because it was sent with an invalid quaternion"
MIN_SQUARED_NORM = 1e-6
TILT_TOLERANCE = 1e-3


class InvalidGoal(NavigationError):
    """A goal with an invalid pose; the text is the action's result."""

    code = "INVALID_GOAL"


class GoalFrameUnknown(NavigationError):
    """A goal in a frame that is not connected to the map."""

    code = "TF_ERROR"
    outcome = 16


def goal_from_msg(message: PoseStamped, map_frame: str, transforms: Transforms) -> Pose2:
    """Transform a goal into the map frame by the latest transforms, whatever its stamp.

    Args:
        message: Goal pose.
        map_frame: Frame of the map.
        transforms: Transforms from tf.

    Returns:
        Goal pose in the map frame.

    Raises:
        InvalidGoal: The pose is not finite, or its quaternion is invalid or not about the vertical.
        GoalFrameUnknown: Its frame is not connected to the map.
    """
    if not is_upright(message.pose.orientation):
        raise InvalidGoal(INVALID_QUATERNION)
    try:
        goal = pose2_from_msg(message.pose)
    except MessageError as error:
        raise InvalidGoal(f"Aborting on goal because {error}") from None
    frame = frame_name(message.header.frame_id)
    if frame == map_frame:
        return goal
    frame_in_map = transforms.lookup(map_frame, frame) if frame else None
    if frame_in_map is None:
        raise GoalFrameUnknown(f"the goal's frame '{frame}' is not connected to {map_frame}")
    return frame_in_map @ goal


def is_upright(quaternion) -> bool:
    """Check whether a quaternion is finite, not zero and a rotation about the vertical."""
    parts = (quaternion.x, quaternion.y, quaternion.z, quaternion.w)
    squared = sum(part * part for part in parts)
    if not math.isfinite(squared) or squared < MIN_SQUARED_NORM:
        return False
    z_of_up = 1.0 - 2.0 * (quaternion.x**2 + quaternion.y**2) / squared
    return abs(z_of_up - 1.0) <= TILT_TOLERANCE
