"""What the node receives, combined to the inputs of a control tick."""

import threading
from collections import deque
from typing import Any, Deque, Dict, List, Optional, Tuple

import rospy
from kobuki_msgs.msg import DockInfraRed, SensorState
from nav_msgs.msg import Odometry

from auto_docking_lite.config import NodeSettings
from auto_docking_lite.contract import DockInputs
from planar import Pose2
from planar_ros.messages.conversion import LaserScanArrays, pose2_from_msg
from planar_ros.messages.newest_scan import NewestScan
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import MessageError, subscribe

# Age from which a signal's odometry does not belong to it [s], and kept messages of odometry.
MAX_SKEW, ODOMETRY_MESSAGES = 0.1, 100
# Time without a message after which a topic counts as silent [s].
SILENT_SECONDS = 2.0
# Number of receivers.
RECEIVERS = 3


class DockTopics:
    """Subscribes to odometry, base state, infrared signals and scans.

    Args:
        settings: Frames.
        transforms: Transforms of the robot.
    """

    def __init__(self, settings: NodeSettings, transforms: Transforms):
        self._settings, self._transforms = settings, transforms
        self._lock = threading.Lock()
        self._odometry: Deque[Tuple[float, Pose2]] = deque(maxlen=ODOMETRY_MESSAGES)
        self._signals: List[Tuple[float, Tuple[int, int, int]]] = []
        self._core: Optional[SensorState] = None
        self._scans = NewestScan(transforms, settings.robot_base_frame)
        self._seen: Dict[str, float] = {}
        self._subscribers = [
            subscribe("~odom", Odometry, self._on_odometry, queue_size=10),
            subscribe("~core", SensorState, self._on_core, queue_size=10),
            subscribe("~dock_ir", DockInfraRed, self._on_signals, queue_size=10),
            subscribe("scan", LaserScanArrays, self._on_scan, queue_size=1),
        ]

    def silent(self, now: float) -> List[str]:
        """Return the topics, except scans, from which no message has come for some time.

        Args:
            now: ROS time [s].
        """
        names = [rospy.resolve_name(name) for name in ("~odom", "~core", "~dock_ir")]
        return [name for name in names if now - self._seen.get(name, -SILENT_SECONDS) >= SILENT_SECONDS]

    def clear(self) -> None:
        """Discard all messages, as after time has jumped back."""
        with self._lock:
            self._odometry.clear()
            self._signals.clear()
            self._seen.clear()
            self._core = None
        self._scans.clear()

    def collect(self, now: float) -> Optional[DockInputs]:
        """Return the inputs of a control tick, with the signals since the last call; None without odometry.

        Args:
            now: ROS time [s].
        """
        settings = self._settings
        with self._lock:
            core, odometry = self._core, list(self._odometry)
            signals, self._signals = self._signals, []
        if core is None or not odometry:
            return None
        matched = []
        for stamp, signal in signals:
            at, pose = min(odometry, key=lambda each: abs(each[0] - stamp))  # noqa: B023
            if abs(at - stamp) <= MAX_SKEW:
                matched.append((pose, signal))
        odom_in_map = self._transforms.lookup(settings.global_frame, settings.odom_frame)
        placed, base = self._scans.latest(), odometry[-1][1]
        scan = placed[0] if placed else None
        return DockInputs(now, base, tuple(matched), core.bumper, core.charger, scan, odom_in_map)

    def _record(self, name: str) -> None:
        self._seen[rospy.resolve_name(name)] = rospy.get_time()

    def _on_odometry(self, message: Any) -> None:
        with self._lock:
            self._odometry.append((message.header.stamp.to_sec(), pose2_from_msg(message.pose.pose)))
        self._record("~odom")

    def _on_core(self, message: Any) -> None:
        self._core = message
        self._record("~core")

    def _on_signals(self, message: Any) -> None:
        data = tuple(message.data)
        if len(data) != RECEIVERS:
            raise MessageError(f"data must have {RECEIVERS} bytes, right, centre and left, got {len(data)}")
        with self._lock:
            self._signals.append((message.header.stamp.to_sec(), (data[0], data[1], data[2])))
        self._record("~dock_ir")

    def _on_scan(self, message: Any) -> None:
        self._scans.add(message, rospy.get_time())
