"""The node ``turtlebot3_fake_node``: odometry and joint states of an ideal differential drive."""

import threading

import rospy
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tf2_ros import TransformBroadcaster

from planar import SettingsError, Twist2
from planar_ros.messages.conversion import pose2_to_msg
from planar_ros.node.runner import run
from turtlebot3_fake.differential_drive import TRACKS, DifferentialDrive

RATE = 30.0
# Diagonal of the covariances of pose and velocity: x, y, z, roll, pitch, yaw.
VARIANCES = (0.1, 0.1, 1e6, 1e6, 1e6, 0.2)


class FakeNode:
    """Integrates the velocity command in a timer; it expires after a second."""

    def __init__(self) -> None:
        model = rospy.get_param("tb3_model", "")
        if model not in TRACKS:
            raise SettingsError(f"parameter tb3_model: {model!r} is not one of {', '.join(TRACKS)}")
        names = ("wheel_left_joint", "wheel_right_joint")
        self._joints = [rospy.get_param(f"{name}_name", name) for name in names]
        self._joint_frame = rospy.get_param("joint_states_frame", "base_footprint")
        self._odom_frame = rospy.get_param("odom_frame", "odom")
        self._base_frame = rospy.get_param("base_frame", "base_footprint")
        self._drive, self._lock = DifferentialDrive(model, rospy.get_time()), threading.Lock()
        self._odometry = rospy.Publisher("odom", Odometry, queue_size=100)
        self._joint_states = rospy.Publisher("joint_states", JointState, queue_size=100)
        self._broadcaster = TransformBroadcaster()
        rospy.Subscriber("cmd_vel", Twist, self._on_command, queue_size=100)
        self._timer = rospy.Timer(rospy.Duration(1.0 / RATE), self._on_tick, reset=True)

    def _on_command(self, message: Twist) -> None:
        with self._lock:
            self._drive.command(Twist2(message.linear.x, message.angular.z), rospy.get_time())

    def _on_tick(self, _event: object) -> None:
        now = rospy.Time.now()
        with self._lock:
            state = self._drive.advance(now.to_sec())
        odometry = Odometry(child_frame_id=self._base_frame)
        odometry.header.frame_id, odometry.header.stamp = self._odom_frame, now
        odometry.pose.pose = pose2_to_msg(state.base_in_odom)
        odometry.twist.twist.linear.x, odometry.twist.twist.angular.z = state.twist.v, state.twist.omega
        for number, variance in enumerate(VARIANCES):
            odometry.pose.covariance[7 * number] = odometry.twist.covariance[7 * number] = variance
        joints = JointState(
            name=self._joints, position=state.angles, velocity=state.speeds, effort=[0.0, 0.0]
        )
        joints.header.frame_id, joints.header.stamp = self._joint_frame, now
        transform = TransformStamped(header=odometry.header, child_frame_id=self._base_frame)
        transform.transform.translation.x = state.base_in_odom.x
        transform.transform.translation.y = state.base_in_odom.y
        transform.transform.rotation = odometry.pose.pose.orientation
        self._odometry.publish(odometry)
        self._joint_states.publish(joints)
        self._broadcaster.sendTransform(transform)


def main() -> None:
    run("turtlebot3_fake_node", FakeNode)
