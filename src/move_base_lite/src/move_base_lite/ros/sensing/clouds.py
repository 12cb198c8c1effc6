"""Conversion of point clouds to arrays."""

import numpy as np
from sensor_msgs.msg import PointCloud, PointCloud2


def points_of(message) -> np.ndarray:
    """Convert a point cloud message to points.

    Args:
        message: PointCloud or PointCloud2.

    Returns:
        (N, 3), float64, in the frame of the message [m]; may contain NaN.
    """
    if isinstance(message, PointCloud):
        return np.array([(point.x, point.y, point.z) for point in message.points]).reshape(-1, 3)
    return _points_of_cloud2(message)


def _points_of_cloud2(message: PointCloud2) -> np.ndarray:
    fields = {field.name: field for field in message.fields}
    is_packed = [fields[axis].offset for axis in "xyz"] == [0, 4, 8] and message.point_step % 4 == 0
    if is_packed and not message.is_bigendian and message.row_step == message.width * message.point_step:
        values = np.frombuffer(message.data, dtype="<f4").reshape(-1, message.point_step // 4)
        return values[:, :3].astype(np.float64)
    order = ">" if message.is_bigendian else "<"
    point = np.dtype(
        {
            "names": list("xyz"),
            "formats": [order + "f4"] * 3,
            "offsets": [fields[axis].offset for axis in "xyz"],
            "itemsize": message.point_step,
        }
    )
    rows = np.frombuffer(message.data, dtype=np.uint8).reshape(message.height, message.row_step)
    packed = np.ascontiguousarray(rows[:, : message.width * message.point_step]).view(point)
    return np.stack([packed[axis].ravel().astype(np.float64) for axis in "xyz"], axis=1)
