"""What the robot's transforms, odometry and laser say at a control tick."""

import threading
from collections import deque
from dataclasses import dataclass, replace
from typing import Deque, Dict, Optional, Tuple

import rospy
from nav_msgs.msg import Odometry

from move_base_lite.config import NavigatorSettings
from planar import Pose2, Scan, Twist2
from planar_ros.messages import LaserScanArrays, frame_name, scan_from_msg
from planar_ros.transforms import Transforms

SCANS_KEPT = 5


@dataclass(frozen=True)
class View:
    """The robot now; ``scan``: one not given before, as seen from the present pose, if there is one."""

    base_in_map: Pose2
    base_in_odom: Pose2
    twist: Twist2
    scan: Optional[Scan]


class Surroundings:
    """Callbacks store; :meth:`view` puts together what there is."""

    def __init__(self, settings: NavigatorSettings, transforms: Transforms, odom_topic: str):
        self._transforms = transforms
        self._global_frame = frame_name(settings.global_costmap.global_frame)
        self._local_frame = frame_name(settings.local_costmap.global_frame)
        self._base_frame = frame_name(settings.local_costmap.robot_base_frame)
        self._tolerances = (
            settings.global_costmap.transform_tolerance,
            settings.local_costmap.transform_tolerance,
        )
        self._twist = Twist2()
        self._scans: Deque[LaserScanArrays] = deque(maxlen=SCANS_KEPT)
        self._lock = threading.Lock()
        self._mountings: Dict[str, Tuple[Pose2, bool]] = {}
        self.has_scan = False
        rospy.Subscriber(odom_topic, Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        self._scan_topic = settings.local_costmap.obstacles.topic
        rospy.Subscriber(
            self._scan_topic, LaserScanArrays, self._on_scan, queue_size=SCANS_KEPT, tcp_nodelay=True
        )

    @property
    def scan_topic(self) -> str:
        return rospy.resolve_name(self._scan_topic)

    def view(self, now: rospy.Time) -> Optional[View]:
        """The robot as far as it is known at ``now``; None if its transforms are missing or too old."""
        if self.missing_transform(now) is not None:
            return None
        base_in_odom = self._transforms.lookup(self._local_frame, self._base_frame)
        odom_in_map = self._transforms.lookup(self._global_frame, self._local_frame)
        if base_in_odom is None or odom_in_map is None:
            return None
        return View(odom_in_map @ base_in_odom, base_in_odom, self._twist, self._newest_scan(base_in_odom))

    def missing_transform(self, now: rospy.Time) -> Optional[str]:
        """Which transform is not known or too old, for people; None if all are well."""
        pairs = (self._global_frame, self._local_frame), (self._local_frame, self._base_frame)
        for (parent, child), tolerance in zip(pairs, self._tolerances):
            latest = self._transforms.latest_stamp(parent, child)
            if latest is None:
                return f"the transform {parent} -> {child}"
            if parent != child and latest != rospy.Time(0) and (now - latest).to_sec() > tolerance:
                return f"a transform {parent} -> {child} that is not {(now - latest).to_sec():.1f} s old"
        return None

    def forget(self) -> None:
        """Time has jumped back: what was heard is worthless."""
        with self._lock:
            self._scans.clear()
        self._transforms.clear()

    def _newest_scan(self, base_in_odom: Pose2) -> Optional[Scan]:
        with self._lock:
            waiting = list(self._scans)
        for message in reversed(waiting):
            scan = self._seen_from(base_in_odom, message)
            if scan is not None:
                with self._lock:
                    while self._scans and self._scans[0].header.stamp <= message.header.stamp:
                        self._scans.popleft()
                return scan
        return None

    def _seen_from(self, base_in_odom: Pose2, message) -> Optional[Scan]:
        """The scan as if taken from the present pose; None as long as it is not known where it was taken."""
        frame = frame_name(message.header.frame_id)
        base_then = self._transforms.lookup(self._local_frame, self._base_frame, message.header.stamp)
        mounting = self._mountings.get(frame) or self._transforms.mounting(self._base_frame, frame)
        if base_then is None or mounting is None:
            return None
        self._mountings[frame] = mounting
        scan = scan_from_msg(message, *mounting)
        return replace(scan, laser_in_base=base_in_odom.inverse() @ base_then @ scan.laser_in_base)

    def _on_odometry(self, message):
        twist = message.twist.twist
        self._twist = Twist2(twist.linear.x, twist.angular.z)

    def _on_scan(self, message):
        self.has_scan = True
        with self._lock:
            self._scans.append(message)
