"""Camera images, shown beside the world."""

import numpy as np

from cockpit.drawing import CameraImage, LayerUpdate, PlacedShape
from cockpit.errors import CockpitError
from cockpit.layer import DisplayLayer

# The channels of each encoding, in the order red, green, blue.
CHANNELS = {
    "rgb8": (3, (0, 1, 2)),
    "bgr8": (3, (2, 1, 0)),
    "rgba8": (4, (0, 1, 2)),
    "bgra8": (4, (2, 1, 0)),
    "mono8": (1, (0, 0, 0)),
}
WIDEST = 480
FAR = 5.0


def draw(message) -> LayerUpdate:
    if not 0 < message.width * message.height <= 1 << 24:
        raise CockpitError(f"a picture of {message.width} x {message.height}")
    picture = _depth(message) if message.encoding in ("32FC1", "16UC1") else _colours(message)
    step = max(1, -(-picture.shape[1] // WIDEST))
    return LayerUpdate(
        (PlacedShape("picture", "", CameraImage(np.ascontiguousarray(picture[::step, ::step]))),)
    )


def _rows(message, width: int) -> np.ndarray:
    """Return the bytes of each row without padding."""
    content = np.frombuffer(bytes(message.data), np.uint8)
    if message.step < width or len(content) < message.step * message.height:
        raise CockpitError(
            f"a picture of {len(content)} bytes, {message.height} rows of {message.step} wanted"
        )
    return content[: message.step * message.height].reshape(message.height, message.step)[:, :width]


def _colours(message) -> np.ndarray:
    if message.encoding not in CHANNELS:
        raise CockpitError(f"pictures of encoding {message.encoding!r} cannot be shown")
    count, order = CHANNELS[message.encoding]
    return _rows(message, message.width * count).reshape(message.height, message.width, count)[:, :, order]


def _depth(message) -> np.ndarray:
    """Draw near pixels bright and unknown ones black."""
    is_metres = message.encoding == "32FC1"
    kind = np.dtype(np.float32 if is_metres else np.uint16).newbyteorder(">" if message.is_bigendian else "<")
    rows = np.ascontiguousarray(_rows(message, message.width * kind.itemsize)).view(kind)
    metres = np.nan_to_num(rows.astype(np.float32), nan=0.0, posinf=0.0) * (1.0 if is_metres else 0.001)
    shade = np.where(metres > 0.0, 255.0 - 225.0 * np.clip(metres / FAR, 0.0, 1.0), 0.0).astype(np.uint8)
    return np.repeat(shade[:, :, None], 3, axis=2)


LAYER = DisplayLayer("Cameras", ("sensor_msgs/Image",), lambda: draw, seconds=0.2)
