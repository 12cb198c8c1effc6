"""Plays a bag straight into a node: ``amcl --run-from-bag``."""

import time

import rosbag
import rospy
from tf2_msgs.msg import TFMessage

from planar import PlanarError
from planar_ros.messages.conversion import LaserScanArrays
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms

TF_TOPICS = ("tf", "/tf", "/tf_static")
POLL_SECONDS = 0.01


class BagError(PlanarError):
    """A bag cannot be read."""


def play_bag(path: str, transforms: Transforms, scans: ScanQueue, scan_period: float) -> None:
    """Feeds the bag's transforms and scans to ``transforms`` and ``scans``; returns when all are dealt with.

    ``scan_period``: wall seconds between scans, 0 or less for none. What is fed is published too. Raises
    BagError.
    """
    scan_topics = (scans.topic, scans.topic.lstrip("/"))
    scan_publisher = rospy.Publisher(scans.topic, LaserScanArrays, queue_size=100)
    tf_publisher = rospy.Publisher("/tf", TFMessage, queue_size=100)
    try:
        with rosbag.Bag(path) as bag:
            for topic, message, _ in bag.read_messages(topics=(*scan_topics, *TF_TOPICS)):
                if rospy.is_shutdown():
                    return
                if topic in TF_TOPICS:
                    transforms.take(message, is_static=topic == "/tf_static")
                    tf_publisher.publish(message)
                    continue
                scans.take(message)
                scan_publisher.publish(message)
                _wait_until(lambda: scans.waiting < scans.size)
                if scan_period > 0.0:
                    time.sleep(scan_period)
    except (OSError, rosbag.ROSBagException) as error:
        raise BagError(f"{path}: {error}") from None
    scans.take_no_more()
    _wait_until(lambda: scans.waiting == 0)


def _wait_until(is_so):
    while not is_so() and not rospy.is_shutdown():
        time.sleep(POLL_SECONDS)
