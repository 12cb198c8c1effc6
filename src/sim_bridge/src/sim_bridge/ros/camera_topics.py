"""Topics of a camera: images, camera info and point cloud."""

from typing import Callable, List, Tuple

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField

from sim_bridge.ros.publishers import RobotPublishers
from sim_bridge.sensors.camera import CameraProfile, CameraReading, CameraSettings, depth_to_points

# Layout of points in gazebo_plugins' openni_kinect.
POINT_OFFSETS = {"x": 0, "y": 4, "z": 8, "rgb": 16}
POINT: np.dtype = np.dtype(
    {
        "names": list(POINT_OFFSETS),
        "formats": ["<f4", "<f4", "<f4", "<u4"],
        "offsets": list(POINT_OFFSETS.values()),
        "itemsize": 32,
    }
)
# Ten point clouds would take 100 MB.
QUEUE_SIZE = 2
POINT_FIELDS = [PointField(name, offset, PointField.FLOAT32, 1) for name, offset in POINT_OFFSETS.items()]


class CameraTopics:
    """Publishes the images of a camera on the topics that have subscribers.

    Args:
        profile: Frame, lens and topics.
        publishers: Publishers of the robot.
    """

    def __init__(self, profile: CameraProfile, publishers: RobotPublishers):
        self._settings = profile.settings
        self._frame = publishers.frame(profile.frame)
        kinds = (
            (profile.image_topic, Image, _colour_msg),
            (profile.info_topic, CameraInfo, _info_msg),
            (profile.depth_topic, Image, _depth_msg),
            (profile.depth_info_topic, CameraInfo, _info_msg),
            (profile.points_topic, PointCloud2, _points_msg),
        )
        self._topics: List[Tuple[rospy.Publisher, Callable]] = [
            (publishers.publisher(topic, kind, QUEUE_SIZE), message_of)
            for topic, kind, message_of in kinds
            if topic
        ]

    def has_subscribers(self) -> bool:
        """Return whether any topic has subscribers."""
        return any(topic.get_num_connections() for topic, _ in self._topics)

    def publish(self, image: CameraReading, stamp: rospy.Time) -> None:
        """Publish the images.

        Args:
            image: Colour and depth image.
            stamp: Time of the measurement.
        """
        for topic, message_of in self._topics:
            if topic.get_num_connections():
                message = message_of(image, self._settings)
                message.header.stamp, message.header.frame_id = stamp, self._frame
                topic.publish(message)


def _colour_msg(image: CameraReading, _settings: CameraSettings) -> Image:
    return _image_msg(image.rgb, "rgb8")


def _depth_msg(image: CameraReading, _settings: CameraSettings) -> Image:
    """Make a depth image in metres (REP 118)."""
    return _image_msg(image.depth, "32FC1")


def _image_msg(pixels: np.ndarray, encoding: str) -> Image:
    height, width = pixels.shape[:2]
    return Image(
        height=height, width=width, encoding=encoding, step=pixels.nbytes // height, data=pixels.tobytes()
    )


def _info_msg(_image: CameraReading, settings: CameraSettings) -> CameraInfo:
    (x, y), scale = settings.centre, settings.focal_length
    return CameraInfo(
        height=settings.height,
        width=settings.width,
        distortion_model="plumb_bob",
        D=[0.0] * 5,
        K=[scale, 0.0, x, 0.0, scale, y, 0.0, 0.0, 1.0],
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=[scale, 0.0, x, 0.0, 0.0, scale, y, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def _points_msg(image: CameraReading, settings: CameraSettings) -> PointCloud2:
    height, width = image.depth.shape
    cloud = np.zeros((height, width), dtype=POINT)
    points = depth_to_points(image.depth, settings)
    for axis, name in enumerate("xyz"):
        cloud[name] = points[..., axis]
    red, green, blue = np.moveaxis(image.rgb.astype(np.uint32), -1, 0)
    cloud["rgb"] = red << 16 | green << 8 | blue
    return PointCloud2(
        height=height,
        width=width,
        fields=POINT_FIELDS,
        is_bigendian=False,
        point_step=POINT.itemsize,
        row_step=POINT.itemsize * width,
        data=cloud.tobytes(),
        is_dense=False,
    )
