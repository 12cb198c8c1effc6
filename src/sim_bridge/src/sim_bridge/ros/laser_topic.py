"""A range finder's topic."""

import rospy

from planar import Scan
from planar_ros.messages.conversion import LaserScanArrays
from sim_bridge.ros.outlet import Outlet
from sim_bridge.sensors.lidar import LaserProfile


class LaserTopic:
    """Scans; the sweep itself does not wait for subscribers."""

    def __init__(self, profile: LaserProfile, outlet: Outlet):
        self._scan_time = profile.scan_time
        self._frame = outlet.frame(profile.frame)
        self._publisher = outlet.publisher(profile.topic, LaserScanArrays)

    def are_wanted(self) -> bool:
        return True

    def publish(self, scan: Scan, stamp: rospy.Time) -> None:
        if not self._publisher.get_num_connections():
            return
        message = LaserScanArrays()
        message.header.stamp = stamp
        message.header.frame_id = self._frame
        message.angle_min = scan.angle_min
        message.angle_increment = scan.angle_increment
        message.angle_max = scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1)
        message.scan_time = self._scan_time
        message.range_min, message.range_max = scan.range_min, scan.range_max
        message.ranges = scan.ranges
        message.intensities = scan.intensities
        self._publisher.publish(message)
