"""Readers of sensors by Gazebo plugin; their topics are in sim_bridge.ros.sensor_topics."""

from typing import Callable, Dict

from sim_bridge.sensors.base import SensorSpec
from sim_bridge.sensors.camera import read_camera, read_depth_camera
from sim_bridge.sensors.element import SensorElement
from sim_bridge.sensors.imu import read_imu
from sim_bridge.sensors.lidar import read_laser

# By the name of the plugin (gazebo_plugins 2.9).
SENSORS: Dict[str, Callable[[SensorElement], SensorSpec]] = {
    "gazebo_ros_laser": read_laser,
    "gazebo_ros_gpu_laser": read_laser,
    "gazebo_ros_camera": read_camera,
    "gazebo_ros_multicamera": read_camera,
    "gazebo_ros_openni_kinect": read_depth_camera,
    "gazebo_ros_depth_camera": read_depth_camera,
    "gazebo_ros_imu_sensor": read_imu,
    "gazebo_ros_imu": read_imu,
    "hector_gazebo_ros_imu": read_imu,
}
# Plugins that may also be directly below a model, with the name of their link.
BODY_SENSORS = ("gazebo_ros_imu_sensor", "gazebo_ros_imu", "hector_gazebo_ros_imu")
