"""Node collision_monitor: limits velocity commands between their source and the drive."""

import threading

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import String

from move_base_lite.collision_monitor import STOPPED, CollisionMonitor, LimitedCommand, MonitorSettings
from move_base_lite.parameters.costmaps import parse_footprint
from planar import Twist2
from planar.config.settings import settings_from
from planar_ros.messages.conversion import LaserScanArrays, frame_name
from planar_ros.messages.newest_scan import NewestScan
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import subscribe
from planar_ros.node.parameters import parameters_below
from planar_ros.node.runner import run
from planar_ros.node.topics import publish_on_shutdown

WARN_SECONDS = 5.0
SILENT = "silent"


class CollisionMonitorNode:
    """Limits ``cmd_vel_in`` based on ``scan``; publishes ``cmd_vel_out`` and ``~state``."""

    def __init__(self):
        parameters = parameters_below("~")
        self._base_frame = frame_name(parameters.pop("base_frame", "base_footprint"))
        self._settings = _settings_from(parameters)
        self._monitor = CollisionMonitor(self._settings)
        self._monitor.limit_command(Twist2(0.1), np.zeros((1, 2)))  # compiles the kernel
        self._scans = NewestScan(Transforms(), self._base_frame)
        self._lock = threading.Lock()
        self._command, self._passed, self._command_stamp = Twist2(), Twist2(), rospy.Time(0)
        self._reason = ""
        self._state = rospy.Publisher("~state", String, queue_size=1, latch=True)
        self._out = rospy.Publisher("cmd_vel_out", Twist, queue_size=1, tcp_nodelay=True)
        publish_on_shutdown(self._out, Twist())
        subscribe("scan", LaserScanArrays, self._on_scan, queue_size=1, tcp_nodelay=True)
        subscribe("cmd_vel_in", Twist, self._on_command, queue_size=1, tcp_nodelay=True)

    def _on_scan(self, message):
        now = rospy.Time.now()
        self._scans.add(message, now.to_sec())
        with self._lock:
            is_fresh = (now - self._command_stamp).to_sec() < self._settings.scan_timeout
            limited = self._limited()
            if is_fresh and limited.command != self._passed:
                self._publish(limited)

    def _on_command(self, message):
        with self._lock:
            self._command = Twist2(message.linear.x, message.angular.z)
            self._command_stamp = rospy.Time.now()
            self._publish(self._limited())

    def _limited(self) -> LimitedCommand:
        placed = self._scans.latest()
        if placed is None or not 0.0 <= rospy.get_time() - placed[1] <= self._settings.scan_timeout:
            return LimitedCommand(Twist2(), SILENT)
        if not self._command.is_finite():
            return LimitedCommand(Twist2(), STOPPED)
        return self._monitor.limit_command(self._command, placed[0].hit_points_in_base())

    def _publish(self, limited: LimitedCommand):
        self._passed = limited.command
        message = Twist()
        message.linear.x, message.angular.z = limited.command.v, limited.command.omega
        self._out.publish(message)
        if limited.reason == SILENT:
            missing = self._scans.missing()
            lacking = f"transform {missing}" if missing else f"scans on {rospy.resolve_name('scan')}"
            rospy.logwarn_throttle(WARN_SECONDS, f"no {lacking}: the robot is stopped")
        if limited.reason != self._reason:
            self._reason = limited.reason
            self._state.publish(limited.reason)


def _settings_from(parameters) -> MonitorSettings:
    where = rospy.get_name() + "/"
    if "footprint" in parameters:
        parameters["footprint"] = parse_footprint(parameters["footprint"], f"{where}footprint")
    settings, unknown = settings_from(MonitorSettings, parameters, where=where)
    for name in unknown:
        rospy.logwarn("unknown parameter %s", where + name)
    return settings


def main():
    """Run the node ``collision_monitor``."""
    run("collision_monitor", CollisionMonitorNode)
