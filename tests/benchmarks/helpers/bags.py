"""Drives written as bags, with one laser or more."""

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from helpers.drives import Observation
from planar import OccupancyGrid, Pose2
from planar.geometry.ray_casting import cast_rays
from planar_ros.messages.conversion import pose2_to_msg, time_of, transform_msg

BASE_FRAME = "base_footprint"
# Bags start here, so that no stamp is 0.
START = 10.0
BEAMS, RANGE_MAX, RANGE_NOISE = 180, 10.0, 0.01


@dataclass(frozen=True)
class Laser:
    """A further laser, of 180 degrees; where it is mounted, and whether upside down."""

    frame: str
    in_base: Pose2
    upside_down: bool = False


def write_bag(
    path: str,
    observations: List[Observation],
    scan_topic: str = "scan",
    grid: Optional[OccupancyGrid] = None,
    lasers: Sequence[Laser] = (),
    base_frame: str = BASE_FRAME,
) -> None:
    """Writes what a robot with a laser measured, beside the truth.

    If ``grid`` is given, ``lasers`` take the place of the drive's own, and measure that map.
    """
    rng = np.random.default_rng(0)
    own = Laser("laser", observations[0].scan.laser_in_base)
    with rosbag.Bag(str(path), "w") as bag:
        mountings = TFMessage([_mounting(laser, base_frame) for laser in (lasers or [own])])
        bag.write("/tf_static", mountings, time_of(START))
        for observation in observations:
            stamp = time_of(START + observation.scan.stamp)
            for then, base_in_odom in (
                *observation.odometry_before,
                (observation.scan.stamp, observation.base_in_odom),
            ):
                odom = transform_msg(base_in_odom, "odom", base_frame, time_of(START + then))
                bag.write("/tf", TFMessage([odom]), time_of(START + then))
            truth = Odometry()
            truth.header.stamp, truth.header.frame_id = stamp, "world"
            truth.pose.pose = pose2_to_msg(observation.base_in_map)
            bag.write("/base_pose_ground_truth", truth, stamp)
            if grid is None:
                bag.write("/" + scan_topic, _own_scan(observation, own, stamp), stamp)
                continue
            for laser in lasers:
                bag.write(
                    "/" + scan_topic, _measured(grid, observation.base_in_map, laser, stamp, rng), stamp
                )


def _mounting(laser: Laser, base_frame: str) -> TransformStamped:
    transform = transform_msg(laser.in_base, base_frame, laser.frame, rospy.Time(0))
    if laser.upside_down:  # turned by pi about its own x axis, then by its yaw
        half = laser.in_base.yaw / 2.0
        transform.transform.rotation = Quaternion(math.cos(half), math.sin(half), 0.0, 0.0)
    return transform


def _own_scan(observation: Observation, laser: Laser, stamp) -> LaserScan:
    scan = observation.scan
    message = LaserScan(angle_min=scan.angle_min, angle_increment=scan.angle_increment)
    message.range_min, message.range_max = scan.range_min, scan.range_max
    return _completed(message, scan.ranges, laser, stamp)


def _measured(grid: OccupancyGrid, base_in_map: Pose2, laser: Laser, stamp, rng) -> LaserScan:
    message = LaserScan(angle_min=-math.pi / 2.0, angle_increment=math.pi / (BEAMS - 1))
    message.range_min, message.range_max = 0.1, RANGE_MAX
    angles = message.angle_min + message.angle_increment * np.arange(BEAMS)
    seen_from_above = -angles if laser.upside_down else angles
    ranges = cast_rays(grid, base_in_map @ laser.in_base, seen_from_above, RANGE_MAX)
    return _completed(message, ranges + rng.normal(0.0, RANGE_NOISE, BEAMS), laser, stamp)


def _completed(message: LaserScan, ranges, laser: Laser, stamp) -> LaserScan:
    message.header.stamp, message.header.frame_id = stamp, laser.frame
    message.angle_max = message.angle_min + (len(ranges) - 1) * message.angle_increment
    message.ranges = np.asarray(ranges, dtype=np.float32).tolist()
    return message
