"""ROS messages to planar types and back."""

import struct
from typing import Sequence

import numpy as np
import rospy
from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion, TransformStamped
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg
from nav_msgs.srv import GetMap, GetMapResponse, SetMap, SetMapRequest
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan, PointCloud2, PointField
from std_msgs.msg import Header

from planar import OccupancyGrid, Pose2, Scan, Twist2
from planar.geometry.limits import MAX_COORDINATE
from planar.geometry.pose import quaternion_zw, yaw_of_quaternion
from planar_ros.messages.validation import MessageError, check_twist

# Message types for subscribers and publishers whose `ranges` and `data` are numpy arrays instead of tuples.
LaserScanArrays = numpy_msg(LaserScan)
OccupancyGridArrays = numpy_msg(OccupancyGridMsg)


class GetMapArrays(GetMap):
    """nav_msgs/GetMap whose map data is a numpy array."""

    _response_class = numpy_msg(GetMapResponse)


class SetMapArrays(SetMap):
    """nav_msgs/SetMap whose map data is a numpy array."""

    _request_class = numpy_msg(SetMapRequest)


def yaw_of(quaternion) -> float:
    """Return the yaw of a geometry_msgs/Quaternion, which need not be normalized [rad]."""
    return yaw_of_quaternion(quaternion.x, quaternion.y, quaternion.z, quaternion.w)


def quaternion_of(yaw: float) -> Quaternion:
    """Return the quaternion of a yaw angle [rad]."""
    return Quaternion(0.0, 0.0, *quaternion_zw(yaw))


def pose2_from_msg(pose) -> Pose2:
    """Convert a geometry_msgs/Pose.

    Raises:
        MessageError: If a coordinate is not finite or out of range.
    """
    return pose2_of(pose.position, pose.orientation)


def pose2_of(position, orientation) -> Pose2:
    """Return the planar pose of a position and an orientation.

    Args:
        position: geometry_msgs/Point or Vector3 [m].
        orientation: geometry_msgs/Quaternion.

    Returns:
        The pose in the plane.

    Raises:
        MessageError: If a coordinate is not finite or out of range.
    """
    found = Pose2(position.x, position.y, yaw_of(orientation))
    if not found.is_in_range():
        raise MessageError(f"a pose at {found.x:g}, {found.y:g}, {found.yaw:g} is out of range")
    return found


def twist2_from_msg(twist) -> Twist2:
    """Convert a geometry_msgs/Twist to forward and turning speed.

    Raises:
        MessageError: If a velocity is not finite or out of range.
    """
    check_twist(twist)
    return Twist2(twist.linear.x, twist.angular.z)


def pose2_to_msg(pose: Pose2) -> Pose:
    """Convert a pose to a geometry_msgs/Pose."""
    return Pose(Point(pose.x, pose.y, 0.0), quaternion_of(pose.yaw))


def frame_name(frame_id: str) -> str:
    """Return a frame's name without a leading slash, as tf2 requires."""
    return frame_id[1:] if frame_id.startswith("/") else frame_id


def transform_msg(child_in_parent: Pose2, parent: str, child: str, stamp) -> TransformStamped:
    """Return the message of a transform.

    Args:
        child_in_parent: Pose of the child frame in the parent frame.
        parent: Parent frame.
        child: Child frame.
        stamp: Time of the transform (rospy.Time).

    Returns:
        The transform.
    """
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = parent
    message.child_frame_id = child
    message.transform.translation.x = child_in_parent.x
    message.transform.translation.y = child_in_parent.y
    message.transform.rotation = quaternion_of(child_in_parent.yaw)
    return message


def grid_from_msg(message) -> OccupancyGrid:
    """Convert a nav_msgs/OccupancyGrid.

    The cells are copied: a message's array may be read-only, for which numba would compile all kernels again.

    Raises:
        PlanarError: If the data has the wrong length, or the resolution or the origin is out of range.
    """
    info = message.info
    if len(message.data) != info.width * info.height:
        size = f"{info.width} x {info.height} cells with {len(message.data)} values"
        raise MessageError(f"invalid map: {size}")
    cells = np.array(message.data, dtype=np.int8).reshape(info.height, info.width)
    return OccupancyGrid(cells, info.resolution, pose2_from_msg(info.origin))


def grid_to_msg(grid: OccupancyGrid, stamp, frame_id: str) -> OccupancyGridMsg:
    """Convert a grid to a message whose data is a flat numpy array.

    Args:
        grid: The grid.
        stamp: Stamp of the message (rospy.Time).
        frame_id: Frame of the map.

    Returns:
        The message; publish it as ``OccupancyGridArrays``, which is faster.
    """
    message = OccupancyGridArrays()
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    message.info.resolution = grid.resolution
    message.info.height, message.info.width = grid.cells.shape
    message.info.origin = pose2_to_msg(grid.origin)
    message.data = np.ascontiguousarray(grid.cells, dtype=np.int8).ravel()
    return message


def scan_from_msg(message, laser_in_base: Pose2, upside_down: bool = False) -> Scan:
    """Convert a sensor_msgs/LaserScan.

    Args:
        message: The message; ``range_max`` is limited to MAX_COORDINATE.
        laser_in_base: Mounting pose of the laser in the base frame.
        upside_down: Whether the laser is mounted upside down.

    Returns:
        The scan.

    Raises:
        PlanarError: If a field other than the ranges is not finite or out of range.
    """
    return Scan(
        stamp=message.header.stamp.to_sec(),
        angle_min=message.angle_min,
        angle_increment=message.angle_increment,
        ranges=np.asarray(message.ranges, dtype=np.float32),
        range_min=message.range_min,
        range_max=min(message.range_max, MAX_COORDINATE),
        laser_in_base=laser_in_base,
        upside_down=upside_down,
    )


def time_of(stamp: float) -> rospy.Time:
    """Convert a time [s] to rospy.Time, rounded to the nearest nanosecond."""
    return rospy.Time(0, round(stamp * 1e9))


class PosesMsg(PoseArray):
    """geometry_msgs/PoseArray that is serialized from an array, and only if there is a subscriber.

    Args:
        poses: Poses (N, 3) ``[x, y, yaw]`` [m, m, rad].
        stamp: Stamp of the message.
        frame_id: Frame of the poses.
    """

    def __init__(self, poses: np.ndarray, stamp: rospy.Time, frame_id: str):
        super().__init__()
        self.header.stamp, self.header.frame_id = stamp, frame_id
        self._poses_xyt = poses

    def serialize(self, buff):
        """Write the message to a buffer in ROS wire format."""
        rows = np.zeros((len(self._poses_xyt), 7), dtype="<f8")
        rows[:, :2] = self._poses_xyt[:, :2]
        rows[:, 5], rows[:, 6] = np.sin(self._poses_xyt[:, 2] / 2.0), np.cos(self._poses_xyt[:, 2] / 2.0)
        self.header.serialize(buff)
        buff.write(struct.pack("<I", len(rows)))
        buff.write(rows.tobytes())


FLOAT_BYTES = 4


def cloud_msg(
    columns: Sequence[np.ndarray], names: Sequence[str], stamp: rospy.Time, frame: str
) -> PointCloud2:
    """Return a point cloud whose fields are all float32.

    Args:
        columns: Values (N,) of each field.
        names: Names of the fields.
        stamp: Stamp of the message.
        frame: Frame of the points.

    Returns:
        The point cloud.
    """
    points = np.column_stack(columns).astype("<f4")
    count, point_step = len(points), FLOAT_BYTES * len(names)
    return PointCloud2(
        header=Header(stamp=stamp, frame_id=frame),
        height=1,
        width=count,
        fields=[PointField(name, FLOAT_BYTES * i, PointField.FLOAT32, 1) for i, name in enumerate(names)],
        point_step=point_step,
        row_step=count * point_step,
        data=points.tobytes(),
        is_dense=True,
    )
