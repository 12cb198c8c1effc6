"""Process a bag inside the node: ``amcl --run-from-bag``."""

import time
from pathlib import Path

import rospy
from tf2_msgs.msg import TFMessage

from amcl_lite.ros.estimate_publisher import EstimatePublisher
from amcl_lite.ros.locked_localizer import LockedLocalizer
from planar_ros.bags.bag_reader import TF, TF_STATIC, BagError, BagReader, absolute_name
from planar_ros.bags.frames import read_tree
from planar_ros.bags.scan_log import NoResultError
from planar_ros.messages.conversion import LaserScanArrays
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms

POLL_SECONDS = 0.01
MAP_POLL_SECONDS = 0.5


class BagProcessor:
    """Processes a bag, logs the final pose and shuts the node down."""

    def __init__(
        self, shared: LockedLocalizer, transforms: Transforms, scans: ScanQueue, publisher: EstimatePublisher
    ):
        self._shared, self._transforms = shared, transforms
        self._scans, self._publisher = scans, publisher

    def run(self, path: Path, localize_globally: bool) -> None:
        """Process the bag after the map has arrived. Raises BagError."""
        while self._shared.localizer is None and not rospy.is_shutdown():
            time.sleep(MAP_POLL_SECONDS)
        if localize_globally:
            self._shared.start_global_localization()
        start = time.monotonic()
        play_bag(path, self._transforms, self._scans, self._shared.settings.bag_scan_period)
        rospy.loginfo("Bag complete, took %.1f seconds to process, shutting down", time.monotonic() - start)
        self._log_final_pose()
        rospy.signal_shutdown("bag complete")

    def _log_final_pose(self):
        estimate, stamp = self._publisher.last_estimate, self._publisher.last_stamp
        if estimate is not None:
            pose = estimate.base_in_map
            place = pose.x, pose.y, pose.yaw, stamp.to_sec()
            rospy.loginfo("Final location %.3f, %.3f, %.3f with stamp=%f", *place)


def play_bag(path: Path, transforms: Transforms, scans: ScanQueue, scan_period: float) -> None:
    """Feed and publish the transforms and scans of a bag; return when all are processed.

    Args:
        path: The bag.
        transforms: Receives the transforms.
        scans: Receives the scans.
        scan_period: Wall time between scans [s]; 0 or less for none.

    Raises:
        NoResultError: If the bag has no scans.
        BagError: If the bag is truncated, after its readable part has been processed.
    """
    scan_topic = absolute_name(scans.topic)
    # On a busy machine its own messages would arrive so late that time seems to jump back.
    scans.unsubscribe()
    scan_publisher = rospy.Publisher(scans.topic, LaserScanArrays, queue_size=100)
    tf_publisher = rospy.Publisher("/tf", TFMessage, queue_size=100)
    bag = BagReader(path)
    if scan_topic not in bag.types:
        topics = ", ".join(sorted(bag.types)) or "none"
        raise NoResultError(f"{path}: no scans on {scan_topic}; topics: {topics}")
    transforms.add(TFMessage(list(read_tree(bag, [TF_STATIC]).first.values())), is_static=True)
    for topic, message, _ in bag.messages([scan_topic, TF, TF_STATIC]):
        if rospy.is_shutdown():
            return
        if topic != scan_topic:
            transforms.add(message, is_static=topic == TF_STATIC)
            tf_publisher.publish(message)
            continue
        scans.add(message)
        scan_publisher.publish(message)
        _wait_until(lambda: scans.waiting < scans.size)
        if scan_period > 0.0:
            time.sleep(scan_period)
    scans.finish()
    _wait_until(lambda: scans.waiting == 0)
    if bag.truncation:
        raise BagError(f"{path}: {bag.truncation}")


def _wait_until(is_so):
    while not is_so() and not rospy.is_shutdown():
        time.sleep(POLL_SECONDS)
