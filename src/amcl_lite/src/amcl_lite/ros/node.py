"""The node ``amcl``: translates between ROS and a Localizer, with the interface of amcl 1.17.

amcl_lite
amcl_lite --explain-params
amcl_lite --run-from-bag BAG [--global-localization]
"""

import argparse
import threading
from pathlib import Path

import rospy
from std_srvs.srv import Empty, EmptyResponse

from amcl_lite.config import CONFIG_FILES, NodeSettings
from amcl_lite.localizer import warm_up
from amcl_lite.ros.estimate_publisher import EstimatePublisher
from amcl_lite.ros.initial_pose import InitialPoseSubscriber
from amcl_lite.ros.locked_localizer import LockedLocalizer
from amcl_lite.ros.map_source import MapSource
from amcl_lite.ros.scan_watchdog import SCAN_TIMEOUT_SECONDS, ScanWatchdog
from amcl_lite.ros.settings import changed_settings, read_node_settings
from amcl_lite.ros.tf_bridge import TfBridge
from amcl_lite.ros.topics import AmclTopics
from planar import PlanarError, SettingsError
from planar.config.config_file import render_yaml
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms
from planar_ros.node.entry import parse_known
from planar_ros.node.parameters import SettingsReconfigureServer, dynamic_values
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run


class AmclNode:
    """The node: passes each scan to the Localizer and publishes the result."""

    def __init__(self, scan_topic: str = "scan"):
        self._lockstep = LockstepClient.of_node()
        settings = read_node_settings()
        self._shared = LockedLocalizer(settings)
        _warm_up(settings)
        views = AmclTopics(self._shared)
        self._transforms = Transforms()
        tf_bridge = TfBridge(self._transforms, self._shared)
        self._publisher = EstimatePublisher(self._shared, views, tf_bridge)
        self._watchdog = ScanWatchdog(rospy.resolve_name(scan_topic))
        self._scans = ScanQueue(
            self._transforms,
            settings.odom_frame,
            settings.base_frame,
            self._on_scan,
            self._on_skipped_scan,
            scan_topic,
        )
        rospy.Service("global_localization", Empty, self._on_global_localization)
        rospy.Service("request_nomotion_update", Empty, self._on_request_update)
        poses = InitialPoseSubscriber(self._shared, tf_bridge, self._lockstep)
        self._map_source = MapSource(self._shared, views.publish_likelihood_field, poses.handle)
        self._watchdog.start()
        rospy.on_shutdown(self._publisher.save_pose)
        self._monitor_inputs()
        SettingsReconfigureServer(settings, self._on_reconfigure)
        self._lockstep.join(lambda: settings.use_map_topic or self._shared.localizer is not None)

    def fetch_map(self) -> None:
        """Wait for the map of the service, unless it comes by topic. Raises PlanarError if it is invalid."""
        self._map_source.fetch()

    def run_from_bag(self, path: str, localize_globally: bool) -> None:
        """Process a bag, log the final pose and shut the node down."""
        from amcl_lite.ros.bag_player import BagProcessor  # late: rosbag needs memory and is rarely used

        bag_player = BagProcessor(self._shared, self._transforms, self._scans, self._publisher)
        bag_player.run(Path(path), localize_globally)

    def _monitor_inputs(self):
        frames = self._shared.settings.odom_frame, self._shared.settings.base_frame
        ReadinessMonitor(
            {
                f"a map from the {self._map_source.name}": lambda: self._shared.localizer is not None,
                f"a scan on {self._scans.topic}": lambda: self._scans.has_received,
                "the transform {} -> {}".format(*frames): lambda: self._transforms.latest_stamp(*frames)
                is not None,
            }
        )

    def _on_global_localization(self, request):
        self._shared.start_global_localization()
        return EmptyResponse()

    def _on_request_update(self, request):
        self._shared.request_update()
        return EmptyResponse()

    def _on_scan(self, message, scan, base_in_odom):
        stamp, laser = message.header.stamp, frame_name(message.header.frame_id)
        self._watchdog.on_scan()
        with self._shared.lock:
            localizer = self._shared.localizer
            if localizer is not None:
                try:
                    self._publisher.restore_checkpoint(localizer)
                    updates = localizer.updates
                    estimate = localizer.update(base_in_odom, scan, laser)
                    is_updated = localizer.updates != updates
                    self._publisher.publish(localizer, estimate, is_updated, base_in_odom, stamp)
                except PlanarError as error:
                    rospy.logerr_throttle(SCAN_TIMEOUT_SECONDS, f"scan ignored: {error}")
        self._lockstep.report(stamp)

    def _on_skipped_scan(self, message, reason):
        rospy.logwarn_throttle(SCAN_TIMEOUT_SECONDS, f"Failed to compute odom pose, skipping scan ({reason})")
        self._watchdog.on_scan()
        self._lockstep.report(message.header.stamp)

    def _on_reconfigure(self, values):
        try:
            settings = changed_settings(self._shared.settings, values)
        except SettingsError as error:
            rospy.logerr("refused: %s", error)
            return dynamic_values(self._shared.settings)
        with self._shared.lock:
            self._scans.set_frames(settings.odom_frame, settings.base_frame)
            self._shared.reconfigure(settings)
        return dynamic_values(settings)


def _warm_up(settings: NodeSettings) -> None:
    """Compile or load the kernels before the first scan; log if that takes long."""
    is_warm = threading.Event()
    ReadinessMonitor({"its kernels to be compiled, as after each installation": is_warm.is_set})
    warm_up(settings)
    is_warm.set()


def main():
    parser = argparse.ArgumentParser(
        prog="amcl_lite", description="Localizes a robot in a known map.", allow_abbrev=False
    )
    parser.add_argument("--explain-params", action="store_true", help="print all parameters, with meanings")
    parser.add_argument("--run-from-bag", metavar="BAG", help="work through topics tf and base_scan of a bag")
    parser.add_argument("--global-localization", action="store_true", help="of the bag the start is unknown")
    arguments = parse_known(parser, rospy.myargv()[1:])
    if arguments.explain_params:
        print(render_yaml(CONFIG_FILES["amcl_lite.yaml"]), end="")
        return
    run("amcl", lambda: _start(arguments))


def _start(arguments):
    node = AmclNode("base_scan" if arguments.run_from_bag else "scan")
    node.fetch_map()
    if arguments.run_from_bag:
        node.run_from_bag(arguments.run_from_bag, arguments.global_localization)
    return node
