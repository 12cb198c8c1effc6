"""Conversion of readings to messages; the publisher fills in the header."""

from geometry_msgs.msg import Point, Quaternion, Vector3
from home_service_msgs.msg import DetectedObject, DetectedObjects
from kobuki_msgs.msg import DockInfraRed
from sensor_msgs.msg import Imu

from planar import Scan
from planar.detection import Detections
from planar_ros.messages.conversion import LaserScanArrays
from sim_bridge.geometry.pose3 import quaternion
from sim_bridge.ros.messages import covariance_of
from sim_bridge.sensors.dock_ir import DockIrProfile, DockSignals
from sim_bridge.sensors.imu import ImuProfile, ImuReading
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.object_detector import ObjectDetectorProfile


def scan_to_msg(scan: Scan, profile: LaserProfile) -> LaserScanArrays:
    message = LaserScanArrays()
    message.angle_min = scan.angle_min
    message.angle_increment = scan.angle_increment
    # As gazebo_ros_laser does, several rows follow each other, and the angles are those of one.
    beams = len(scan.ranges) if profile.grid is None else profile.beams
    message.angle_max = scan.angle_min + scan.angle_increment * (beams - 1)
    message.scan_time = profile.scan_time
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.ranges = scan.ranges
    message.intensities = scan.intensities
    return message


def imu_to_msg(reading: ImuReading, profile: ImuProfile) -> Imu:
    return Imu(
        orientation=Quaternion(*quaternion(reading.orientation)),
        orientation_covariance=covariance_of(profile.orientation_variances),
        angular_velocity=Vector3(*reading.angular_velocity),
        angular_velocity_covariance=covariance_of(profile.angular_velocity_variances),
        linear_acceleration=Vector3(*reading.acceleration),
        linear_acceleration_covariance=covariance_of(profile.acceleration_variances),
    )


def dock_ir_to_msg(signals: DockSignals, _profile: DockIrProfile) -> DockInfraRed:
    """Return the message of the right, centre and left receiver's bytes; its header is set later."""
    return DockInfraRed(data=bytes(signals))


def detections_to_msg(detections: Detections, _profile: ObjectDetectorProfile) -> DetectedObjects:
    """Return the message of what a detector reports of one image; its header is set later."""
    return DetectedObjects(
        objects=[DetectedObject(each.name, Point(each.x, each.y, each.z)) for each in detections]
    )
