"""The node ``amcl``: translates between ROS and a Localizer, with the names and habits of amcl 1.17.

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
from amcl_lite.ros.initial_pose import InitialPoses
from amcl_lite.ros.map_source import MapSource
from amcl_lite.ros.scan_alarm import SCAN_ALARM_SECONDS, ScanAlarm
from amcl_lite.ros.settings import changed_settings, read_node_settings
from amcl_lite.ros.shared_localizer import SharedLocalizer
from amcl_lite.ros.tf_bridge import TfBridge
from amcl_lite.ros.views import Views
from planar import PlanarError, SettingsError
from planar.config.listing import render_yaml
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.scan_queue import ScanQueue
from planar_ros.messages.transforms import Transforms
from planar_ros.node.command_line import parse_known
from planar_ros.node.reconfigure import SettingsReconfigureServer, dynamic_values
from planar_ros.node.shell import run
from planar_ros.node.waiting import ReadinessMonitor
from planar_ros.step import LockstepClient


class AmclNode:
    """Puts the parts together; hands each scan to the one Localizer and publishes what it returns."""

    def __init__(self, scan_topic: str = "scan"):
        self._step = LockstepClient.of_node()
        settings = read_node_settings()
        self._shared = SharedLocalizer(settings)
        _warm_up(settings)
        views = Views(self._shared)
        self._transforms = Transforms()
        tf_bridge = TfBridge(self._transforms, self._shared)
        self._publisher = EstimatePublisher(self._shared, views, tf_bridge)
        self._alarm = ScanAlarm(rospy.resolve_name(scan_topic))
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
        poses = InitialPoses(self._shared, tf_bridge, self._step)
        self._map_source = MapSource(self._shared, views.show_field, poses.take)
        self._alarm.start()
        rospy.on_shutdown(self._publisher.keep_pose)
        self._say_what_is_missing()
        SettingsReconfigureServer(settings, self._on_reconfigure)
        self._step.join(lambda: settings.use_map_topic or self._shared.localizer is not None)

    def fetch_map(self) -> None:
        """Gets the map, however long it takes, if it does not come by topic; PlanarError if it is bad."""
        self._map_source.fetch()

    def run_from_bag(self, path: str, localize_globally: bool) -> None:
        """Works through a bag, says where the robot is in the end, and ends the node."""
        from amcl_lite.ros.bag_player import BagRun  # rosbag takes memory, and is rarely wanted

        bag_run = BagRun(self._shared, self._transforms, self._scans, self._publisher)
        bag_run.work_through(Path(path), localize_globally)

    def _say_what_is_missing(self):
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
        self._shared.scatter()
        return EmptyResponse()

    def _on_request_update(self, request):
        self._shared.request_update()
        return EmptyResponse()

    def _on_scan(self, message, scan, base_in_odom):
        stamp, laser = message.header.stamp, frame_name(message.header.frame_id)
        self._alarm.hear()
        with self._shared.lock:
            localizer = self._shared.localizer
            if localizer is not None:
                try:
                    self._publisher.take_up(localizer)
                    updates = localizer.updates
                    estimate = localizer.update(base_in_odom, scan, laser)
                    is_updated = localizer.updates != updates
                    self._publisher.publish(localizer, estimate, is_updated, base_in_odom, stamp)
                except PlanarError as error:
                    rospy.logerr_throttle(SCAN_ALARM_SECONDS, f"scan ignored: {error}")
        self._step.report(stamp)

    def _on_skipped_scan(self, message, reason):
        rospy.logwarn_throttle(SCAN_ALARM_SECONDS, f"Failed to compute odom pose, skipping scan ({reason})")
        self._alarm.hear()
        self._step.report(message.header.stamp)

    def _on_reconfigure(self, values):
        try:
            settings = changed_settings(self._shared.settings, values)
        except SettingsError as error:
            rospy.logerr("refused: %s", error)
            return dynamic_values(self._shared.settings)
        with self._shared.lock:
            self._scans.use_frames(settings.odom_frame, settings.base_frame)
            self._shared.reconfigure(settings)
        return dynamic_values(settings)


def _warm_up(settings: NodeSettings) -> None:
    """Compiles or loads the kernels, before any scan comes; says so if that takes long."""
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
