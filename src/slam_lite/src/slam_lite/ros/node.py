"""The node ``slam_gmapping``, with the interface of gmapping 1.4."""

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from std_srvs.srv import SetBool, SetBoolResponse

from planar import PlanarError, Pose2
from planar.config.parameters import official_names
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import frame_name, pose2_from_msg, scan_from_msg
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import subscribe
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run
from slam_lite.config import WITHOUT_EFFECT, NodeSettings
from slam_lite.ros.file_services import FileServices
from slam_lite.ros.input_checks import WARNING_SECONDS, LaserMountingCheck, OdometryCheck
from slam_lite.ros.map_publisher import MapPublisher
from slam_lite.ros.map_transform import MapTransformBroadcaster
from slam_lite.ros.state_checkpoint import StateCheckpointer
from slam_lite.ros.thread_safe_mapper import ThreadSafeMapper
from slam_lite.warming import warm_up

SCAN_QUEUE_SIZE = 5
# Why parameters of gmapping's particle filter have no effect.
NO_PARTICLES = "a pose graph has no particles; keyframe_distance and keyframe_angle choose its keyframes"


class SlamNode:
    """Node that passes scans to the mapper; other objects publish the results."""

    def __init__(self):
        self._step = LockstepClient.of_node()
        settings = self._settings = read_settings(
            NodeSettings,
            official_names(NodeSettings),
            ignore=["seed"],
            without_effect=lambda settings: dict.fromkeys(WITHOUT_EFFECT, NO_PARTICLES),
        )
        self._mapper = ThreadSafeMapper(settings)
        self._odometry_check = OdometryCheck()
        self._is_paused = False
        self._scan_count = 0
        if settings.state:
            self._mapper.load(settings.state)
        self._checkpointer = StateCheckpointer(self._mapper) if settings.resume else None
        warm_up(settings.matcher_plugin)
        self._connect()

    def _connect(self):
        settings = self._settings
        self._transforms = Transforms()
        self._mounting_check = LaserMountingCheck(self._transforms, settings.base_frame)
        self._maps = MapPublisher(settings, self._mapper)
        rospy.Service("~pause", SetBool, self._on_pause)
        FileServices(self._mapper, self._maps)
        subscribe("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        self._mapper.start_closing_loops()
        self._scans = ScanQueue(
            self._transforms,
            settings.odom_frame,
            settings.base_frame,
            self._on_scan,
            self._on_skipped_scan,
            size=SCAN_QUEUE_SIZE,
        )
        self._step.on_instant(self._mapper.close_loops)
        self._step.on_instant(self._maps.publish_if_due)
        MapTransformBroadcaster(settings, self._mapper, self._transforms)
        self._step.join()
        ReadinessMonitor(
            {
                f"a scan on {self._scans.topic}": lambda: self._scan_count > 0,
                f"the transform {settings.odom_frame} -> {settings.base_frame}": self._has_odometry,
            }
        )

    def _on_scan(self, message, scan, base_in_odom):
        self._scan_count += 1
        due = (self._scan_count - 1) % self._settings.throttle_scans == 0
        header = message.header
        if due and not self._is_paused and self._mounting_check.is_planar(header.frame_id, header.stamp):
            update = self._mapper.insert(base_in_odom, scan)
            if update is not None:
                self._odometry_check.update(update.odometry_chi_square)
            self._maps.on_scan(scan.stamp)
            if self._checkpointer is not None:
                self._checkpointer.on_scan(scan.stamp)
        self._step.report(header.stamp)

    def _on_skipped_scan(self, message, reason):
        settings, header = self._settings, message.header
        mounting = self._transforms.mounting(settings.base_frame, header.frame_id, header.stamp)
        if mounting is not None and not self._has_odometry():
            rospy.logwarn_throttle(
                WARNING_SECONDS,
                "no odometry (no transform %s -> %s): mapping from the scans alone",
                settings.odom_frame,
                settings.base_frame,
            )
            try:
                self._on_scan(message, scan_from_msg(message, *mounting), Pose2())
                return
            except PlanarError as error:
                reason = str(error)
        rospy.logwarn_throttle(WARNING_SECONDS, "skipping a scan: %s", reason)
        self._step.report(header.stamp)

    def _on_pause(self, request):
        self._is_paused = request.data
        return SetBoolResponse(success=True, message="paused" if request.data else "mapping")

    def _on_initial_pose(self, message):
        if frame_name(message.header.frame_id) != frame_name(self._settings.map_frame):
            rospy.logwarn(
                "ignoring an initial pose in frame %r: it has to be in %r",
                message.header.frame_id,
                self._settings.map_frame,
            )
            return
        try:
            self._mapper.set_pose(pose2_from_msg(message.pose.pose))
        except PlanarError as error:
            rospy.logwarn("ignoring an initial pose: %s", error)

    def _has_odometry(self):
        return self._transforms.latest_stamp(self._settings.odom_frame, self._settings.base_frame) is not None


def main():
    """Run the node ``slam_gmapping``."""
    run("slam_gmapping", SlamNode)
