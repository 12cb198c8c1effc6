"""Which sensor is behind which of Gazebo's plugins; sim_bridge.ros.sensor_topics has their topics."""

from typing import Callable, Dict

from sim_bridge.sensors.base import SensorSpec
from sim_bridge.sensors.camera import read_camera, read_depth_camera
from sim_bridge.sensors.element import SensorElement
from sim_bridge.sensors.imu import read_imu
from sim_bridge.sensors.lidar import read_laser

# By the plugin's name (gazebo_plugins 2.9).
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
# These may also be directly below a model and name the link that they are fixed to.
BODY_SENSORS = ("gazebo_ros_imu_sensor", "gazebo_ros_imu", "hector_gazebo_ros_imu")
