"""A camera's topics: pictures, their calibration and the points that they show."""

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField

from sim_bridge.sensors.camera import CameraSettings, Picture, points_of

# As gazebo_plugins' openni_kinect lays out its points.
POINT = np.dtype(
    {
        "names": ["x", "y", "z", "rgb"],
        "formats": ["<f4", "<f4", "<f4", "<u4"],
        "offsets": [0, 4, 8, 16],
        "itemsize": 32,
    }
)
POINT_FIELDS = [PointField(name, POINT.fields[name][1], PointField.FLOAT32, 1) for name in POINT.names]


class CameraTopics:
    """Publishes below ``namespace`` (e.g. camera/rgb) what is subscribed to, in the optical ``frame``.

    A depth camera's image holds metres (REP 118), and it has points too.
    """

    def __init__(self, settings: CameraSettings, namespace: str, frame: str, is_depth: bool):
        self._settings = settings
        self._frame = frame
        self._is_depth = is_depth
        self._image = self._publisher(namespace, "image_raw", Image)
        self._info = self._publisher(namespace, "camera_info", CameraInfo)
        self._points = self._publisher(namespace, "points", PointCloud2) if is_depth else None

    def are_wanted(self) -> bool:
        """Whether anybody has subscribed."""
        return any(topic.get_num_connections() for topic in self._topics())

    def publish(self, picture: Picture, stamp: rospy.Time) -> None:
        for topic, message_of in (
            (self._image, self._image_msg),
            (self._info, self._info_msg),
            (self._points, self._points_msg),
        ):
            if topic is not None and topic.get_num_connections():
                message = message_of(picture)
                message.header.stamp, message.header.frame_id = stamp, self._frame
                topic.publish(message)

    def close(self) -> None:
        """Takes the topics away."""
        for topic in self._topics():
            topic.unregister()

    def _topics(self):
        return [topic for topic in (self._image, self._info, self._points) if topic is not None]

    def _publisher(self, namespace, topic, kind):
        return rospy.Publisher(rospy.names.ns_join(namespace, topic), kind, queue_size=2, tcp_nodelay=True)

    def _image_msg(self, picture: Picture) -> Image:
        data = picture.depth if self._is_depth else picture.rgb
        height, width = data.shape[:2]
        return Image(
            height=height,
            width=width,
            encoding="32FC1" if self._is_depth else "rgb8",
            step=data.nbytes // height,
            data=data.tobytes(),
        )

    def _info_msg(self, _picture: Picture) -> CameraInfo:
        settings, (x, y) = self._settings, self._settings.centre
        scale = settings.focal_length
        return CameraInfo(
            height=settings.height,
            width=settings.width,
            distortion_model="plumb_bob",
            D=[0.0] * 5,
            K=[scale, 0.0, x, 0.0, scale, y, 0.0, 0.0, 1.0],
            R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            P=[scale, 0.0, x, 0.0, 0.0, scale, y, 0.0, 0.0, 0.0, 1.0, 0.0],
        )

    def _points_msg(self, picture: Picture) -> PointCloud2:
        height, width = picture.depth.shape
        cloud = np.zeros((height, width), dtype=POINT)
        points = points_of(picture.depth, self._settings)
        for axis, name in enumerate("xyz"):
            cloud[name] = points[..., axis]
        red, green, blue = (picture.rgb[..., part].astype(np.uint32) for part in range(3))
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
