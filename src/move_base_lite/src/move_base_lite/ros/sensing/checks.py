"""Validation of sensor messages before they are used."""

from sensor_msgs.msg import PointCloud2, PointField

from planar import Pose2
from planar_ros.messages.conversion import scan_from_msg
from planar_ros.messages.validation import MessageError


def check_message(message) -> None:
    """Validate a scan or point cloud.

    Args:
        message: sensor_msgs LaserScan, PointCloud or PointCloud2.

    Raises:
        MessageError: The message is invalid.
    """
    if isinstance(message, PointCloud2):
        _check_cloud(message)
    elif hasattr(message, "ranges"):
        _check_scan(message)


def _check_scan(message) -> None:
    scan_from_msg(message, Pose2())
    if message.angle_increment == 0.0 or message.range_min >= message.range_max:
        raise MessageError(
            "a scan must have an angle_increment other than 0 and a range_min below range_max, got "
            f"{message.angle_increment:g}, {message.range_min:g} and {message.range_max:g}"
        )


def _check_cloud(message: PointCloud2) -> None:
    fields = {field.name: field for field in message.fields}
    for axis in "xyz":
        if axis not in fields or fields[axis].datatype != PointField.FLOAT32:
            raise MessageError(f"a point cloud must have a float32 field {axis}")
    data_size, row_size = message.height * message.row_step, message.width * message.point_step
    if len(message.data) != data_size or row_size > message.row_step:
        raise MessageError(
            f"a point cloud of {message.width} x {message.height} points must have rows of {row_size} bytes "
            f"or more and {data_size} of data, got rows of {message.row_step} and {len(message.data)} bytes"
        )
