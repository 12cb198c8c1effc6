"""Messages of sensors that mean nothing, told apart before anything is computed from them."""

from sensor_msgs.msg import PointCloud2, PointField

from planar import Pose2
from planar_ros.messages.border import MessageError
from planar_ros.messages.conversion import scan_from_msg


def check_message(message) -> None:
    """Raises PlanarError with what is wrong, for people."""
    if isinstance(message, PointCloud2):
        _check_cloud(message)
    elif hasattr(message, "ranges"):
        _check_scan(message)


def _check_scan(message) -> None:
    scan_from_msg(message, Pose2())
    if message.angle_increment == 0.0 or message.range_min >= message.range_max:
        raise MessageError(
            f"a scan with angle_increment {message.angle_increment:g} and ranges from {message.range_min:g} "
            f"to {message.range_max:g} means nothing"
        )


def _check_cloud(message: PointCloud2) -> None:
    fields = {field.name: field for field in message.fields}
    for axis in "xyz":
        if axis not in fields or fields[axis].datatype != PointField.FLOAT32:
            raise MessageError(f"a point cloud without a float32 field {axis} means nothing")
    needed = message.height * message.row_step
    if len(message.data) != needed or message.width * message.point_step > message.row_step:
        size = f"{message.width} x {message.height} points with {len(message.data)} bytes"
        raise MessageError(f"a point cloud of {size} means nothing")
