"""Arrays as point clouds."""

from typing import Sequence

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

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
