"""ROS messages to planar types and back."""

import math
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
from planar_ros.messages.validation import MessageError, check_twist

# Subscribed to with these types, `ranges` and `data` arrive as numpy arrays instead of tuples.
LaserScanArrays = numpy_msg(LaserScan)
OccupancyGridArrays = numpy_msg(OccupancyGridMsg)


class GetMapArrays(GetMap):
    """nav_msgs/GetMap whose map comes and goes as a numpy array."""

    _response_class = numpy_msg(GetMapResponse)


class SetMapArrays(SetMap):
    """nav_msgs/SetMap whose map comes and goes as a numpy array."""

    _request_class = numpy_msg(SetMapRequest)


def yaw_of(quaternion) -> float:
    """Yaw, radians, of a geometry_msgs/Quaternion of any length but zero."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def quaternion_of(yaw: float) -> Quaternion:
    return Quaternion(0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0))


def pose2_from_msg(pose) -> Pose2:
    """Raises MessageError for a pose at which nothing can be."""
    return pose2_of(pose.position, pose.orientation)


def pose2_of(position, orientation) -> Pose2:
    """The pose in the plane of a point and a quaternion. Raises MessageError, as above."""
    found = Pose2(position.x, position.y, yaw_of(orientation))
    if not found.is_in_range():
        raise MessageError(f"a pose at {found.x:g}, {found.y:g}, {found.yaw:g} means nothing")
    return found


def twist2_from_msg(twist) -> Twist2:
    """Forward and turning speed of a geometry_msgs/Twist. Raises MessageError for none of a robot's."""
    check_twist(twist)
    return Twist2(twist.linear.x, twist.angular.z)


def pose2_to_msg(pose: Pose2) -> Pose:
    return Pose(Point(pose.x, pose.y, 0.0), quaternion_of(pose.yaw))


def frame_name(frame_id: str) -> str:
    """A frame's name as tf2 knows it: without the leading slash of older code."""
    return frame_id[1:] if frame_id.startswith("/") else frame_id


def transform_msg(child_in_parent: Pose2, parent: str, child: str, stamp) -> TransformStamped:
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = parent
    message.child_frame_id = child
    message.transform.translation.x = child_in_parent.x
    message.transform.translation.y = child_in_parent.y
    message.transform.rotation = quaternion_of(child_in_parent.yaw)
    return message


def grid_from_msg(message) -> OccupancyGrid:
    """A grid with cells of its own: a message's may be read-only, and kernels would be compiled anew.

    Raises PlanarError for a message that holds no map.
    """
    info = message.info
    if len(message.data) != info.width * info.height:
        size = f"{info.width} x {info.height} cells with {len(message.data)} values"
        raise MessageError(f"a map of {size} means nothing")
    cells = np.array(message.data, dtype=np.int8).reshape(info.height, info.width)
    return OccupancyGrid(cells, info.resolution, pose2_from_msg(info.origin))


def grid_to_msg(grid: OccupancyGrid, stamp, frame_id: str) -> OccupancyGridMsg:
    """A message whose data is a flat numpy array; publish it with OccupancyGridArrays for speed."""
    message = OccupancyGridArrays()
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    message.info.resolution = grid.resolution
    message.info.height, message.info.width = grid.cells.shape
    message.info.origin = pose2_to_msg(grid.origin)
    message.data = np.ascontiguousarray(grid.cells, dtype=np.int8).ravel()
    return message


def scan_from_msg(message, laser_in_base: Pose2, upside_down: bool = False) -> Scan:
    """Raises PlanarError for a message that holds no scan."""
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
    """Seconds as rospy.Time, to the nearest nanosecond."""
    return rospy.Time(0, round(stamp * 1e9))


class PosesMsg(PoseArray):
    """A geometry_msgs/PoseArray of poses (N, 3) x, y, yaw; serialized in one go, if anybody listens."""

    def __init__(self, poses: np.ndarray, stamp: rospy.Time, frame_id: str):
        super().__init__()
        self.header.stamp, self.header.frame_id = stamp, frame_id
        self._poses_xyt = poses

    def serialize(self, buff):
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
    """A cloud of points from the column (N,) of each of its fields, all float32."""
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
