"""Odometry and transforms with fast serialization: they are sent each step with the same frames."""

import struct

from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from planar import Pose2, Twist2
from planar_ros.messages.conversion import pose2_to_msg, quaternion_of

_POSE = struct.Struct("<7d")
_TWIST = struct.Struct("<6d")
_STAMP = struct.Struct("<3I")


class OdometryMsg(Odometry):
    """A reusable nav_msgs/Odometry.

    Args:
        frame: Parent frame.
        base_frame: Child frame.
        covariance: Covariance (36,) of the pose and of the twist, row by row.
    """

    def __init__(self, frame: str, base_frame: str, covariance):
        super().__init__()
        self.header.frame_id, self.child_frame_id = frame, base_frame
        self.pose.covariance = self.twist.covariance = list(covariance)
        self._frames = _text(frame) + _text(base_frame)
        self._covariance = struct.pack("<36d", *covariance)

    def fill(self, base: Pose2, twist: Twist2, stamp) -> None:
        """Set the values of a message.

        Args:
            base: Pose of the base in the parent frame.
            twist: Velocity in the base frame.
            stamp: Time of the measurement.
        """
        self.header.stamp = stamp
        self.pose.pose = pose2_to_msg(base)
        self.twist.twist.linear.x, self.twist.twist.angular.z = twist.v, twist.omega
        self.twist.twist.linear.y = twist.lateral

    def serialize(self, buff):
        pose, twist = self.pose.pose, self.twist.twist
        buff.write(_STAMP.pack(self.header.seq, self.header.stamp.secs, self.header.stamp.nsecs))
        buff.write(self._frames)
        buff.write(_pose(pose.position, pose.orientation))
        buff.write(self._covariance)
        buff.write(_TWIST.pack(twist.linear.x, twist.linear.y, 0.0, 0.0, 0.0, twist.angular.z))
        buff.write(self._covariance)


class TransformMsg(TransformStamped):
    """A reusable geometry_msgs/TransformStamped.

    Args:
        parent: Parent frame.
        child: Child frame.
    """

    def __init__(self, parent: str, child: str):
        super().__init__()
        self.header.frame_id, self.child_frame_id = parent, child
        self._frames = _text(parent) + _text(child)

    def fill(self, child_in_parent: Pose2, stamp) -> None:
        """Set the values of a message.

        Args:
            child_in_parent: Pose of the child frame.
            stamp: Time of the measurement.
        """
        self.header.stamp = stamp
        self.transform.translation.x = child_in_parent.x
        self.transform.translation.y = child_in_parent.y
        self.transform.rotation = quaternion_of(child_in_parent.yaw)

    def serialize(self, buff):
        buff.write(_STAMP.pack(self.header.seq, self.header.stamp.secs, self.header.stamp.nsecs))
        buff.write(self._frames)
        buff.write(_pose(self.transform.translation, self.transform.rotation))


class TransformsMsg(TFMessage):
    """A tf2_msgs/TFMessage of TransformMsg."""

    def serialize(self, buff):
        buff.write(struct.pack("<I", len(self.transforms)))
        for transform in self.transforms:
            transform.serialize(buff)


def _pose(at, turned) -> bytes:
    return _POSE.pack(at.x, at.y, at.z, turned.x, turned.y, turned.z, turned.w)


def _text(text: str) -> bytes:
    encoded = text.encode()
    return struct.pack("<I", len(encoded)) + encoded
