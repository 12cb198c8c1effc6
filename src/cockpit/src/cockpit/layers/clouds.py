"""Point clouds, coloured by height."""

import numpy as np

from cockpit.drawing import LayerUpdate, PlacedShape, PointCloudShape
from cockpit.errors import CockpitError
from cockpit.layer import DisplayLayer

MOST = 20000
FLOAT32 = 7


def draw(message) -> LayerUpdate:
    fields = {field.name: field for field in message.fields}
    if not {"x", "y", "z"} <= set(fields) or any(fields[axis].datatype != FLOAT32 for axis in "xyz"):
        raise CockpitError("a cloud without x, y and z as float32")
    count = message.width * message.height
    content = np.frombuffer(bytes(message.data), np.uint8)
    step = message.point_step
    ends = [fields[axis].offset + 4 for axis in "xyz"]
    if len(content) < count * step or max(ends) > step:
        raise CockpitError(f"a cloud of {len(content)} bytes, {count} points of {step} wanted")
    rows = content[: count * step].reshape(count, step)[:: count // MOST + 1]
    order = ">" if message.is_bigendian else "<"
    points = np.column_stack(
        [np.ascontiguousarray(rows[:, end - 4 : end]).view(f"{order}f4").reshape(-1) for end in ends]
    )
    points = points[np.isfinite(points).all(axis=1)]
    header, shape = message.header, PointCloudShape(points, colours_of(points[:, 2]), 0.03)
    return LayerUpdate((PlacedShape("cloud", header.frame_id, shape, stamp=header.stamp.to_sec() or None),))


def colours_of(heights: np.ndarray) -> np.ndarray:
    """Return colours (N, 3), uint8, for heights (N,): blue for the lowest to red for the highest."""
    low, high = (heights.min(), heights.max()) if len(heights) else (0.0, 1.0)
    share = (heights - low) / max(float(high - low), 1e-6)
    return np.column_stack((255 * share, 255 * (1 - np.abs(2 * share - 1)), 255 * (1 - share))).astype(
        np.uint8
    )


LAYER = DisplayLayer("Point clouds", ("sensor_msgs/PointCloud2",), lambda: draw, seconds=0.2)
